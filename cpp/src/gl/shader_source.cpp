#include "gl/shader_source.h"

#include "decalgl/core/error.h"

#include <algorithm>

#include <fmt/format.h>

namespace decalgl::gl {
namespace {

constexpr std::string_view default_version = "#version 450 core";

std::string_view trimmed(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

bool starts_with(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

/// The path of an `#include "path"` line, or nothing.
std::string_view included_path(std::string_view line) {
    const std::string_view rest = trimmed(line);
    if (!starts_with(rest, "#include")) {
        return {};
    }
    const std::size_t open = rest.find('"');
    const std::size_t close = open == std::string_view::npos ? open : rest.find('"', open + 1);
    return close == std::string_view::npos ? std::string_view() : rest.substr(open + 1, close - open - 1);
}

/// Joins one stage file by file; a file's index in `files` is its source string number.
class Assembler {
public:
    explicit Assembler(const std::vector<std::string>& defines) : defines_(defines) {}

    StageText run(const std::string& root_path, const std::string& root_text) {
        const bool has_version = root_text.find("#version") != std::string::npos;
        if (!has_version) {
            stage_.text = fmt::format("{}\n", default_version);
            append_defines();
        }
        append_file(root_path, root_text);
        return std::move(stage_);
    }

private:
    void append_defines() {
        for (const std::string& define : defines_) {
            stage_.text += fmt::format("#define {} 1\n", define);
        }
    }

    void append_file(const std::string& path, std::string_view text) {
        const std::size_t number = stage_.files.size();
        stage_.files.push_back(path);
        if (!stage_.text.empty()) {
            stage_.text += fmt::format("#line 1 {}\n", number);
        }
        int line_number = 0;
        while (!text.empty()) {
            const std::size_t end = text.find('\n');
            append_line(path, number, ++line_number, text.substr(0, end));
            text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
        }
    }

    void append_line(const std::string& path, std::size_t number, int line_number, std::string_view line) {
        if (starts_with(trimmed(line), "#version")) {
            stage_.text.append(line);
            stage_.text += '\n';
            append_defines();
            stage_.text += fmt::format("#line {} {}\n", line_number + 1, number);
            return;
        }
        const std::string_view included = included_path(line);
        if (included.empty()) {
            stage_.text.append(line);
            stage_.text += '\n';
            return;
        }
        append_include(path, line_number, std::string(included));
        stage_.text += fmt::format("#line {} {}\n", line_number + 1, number);
    }

    void append_include(const std::string& path, int line_number, const std::string& included) {
        if (std::find(stage_.files.begin(), stage_.files.end(), included) != stage_.files.end()) {
            return;
        }
        const char* text = shader_source(included);
        if (text == nullptr) {
            throw Error(ErrorKind::graphics,
                        fmt::format("{}:{}: there is no shader file \"{}\"; paths start at "
                                    "cpp/shaders.",
                                    path, line_number, included));
        }
        append_file(included, text);
    }

    const std::vector<std::string>& defines_;
    StageText stage_;
};

/// Takes a number off the front of the text; -1 where there is none.
int take_number(std::string_view& text) {
    int value = -1;
    while (!text.empty() && text.front() >= '0' && text.front() <= '9' && value < 1000000) {
        value = 10 * std::max(value, 0) + (text.front() - '0');
        text.remove_prefix(1);
    }
    return value;
}

bool take(std::string_view& text, std::string_view start) {
    const bool taken = starts_with(text, start);
    text.remove_prefix(taken ? start.size() : 0);
    return taken;
}

/// Mesa writes "0:12(3): error", the reference compiler "ERROR: 0:12: ", NVIDIA "0(12) : error".
std::string translate_line(std::string_view line, const std::vector<std::string>& files) {
    std::string_view rest = line;
    const std::string_view prefix = take(rest, "ERROR: ")     ? "ERROR: "
                                    : take(rest, "WARNING: ") ? "WARNING: "
                                                              : "";
    const int file = take_number(rest);
    const bool in_colons = take(rest, ":");
    const bool in_parentheses = !in_colons && take(rest, "(");
    const int line_number = take_number(rest);
    if (in_parentheses) {
        take(rest, ")");
        take(rest, " ");
    } else if (take(rest, "(")) {
        take_number(rest);  // the column
        take(rest, ")");
    }
    const bool known = file >= 0 && static_cast<std::size_t>(file) < files.size() && line_number >= 0;
    if (!known || !(in_colons || in_parentheses)) {
        return std::string(line);
    }
    return fmt::format("{}{}:{}{}", prefix, files[static_cast<std::size_t>(file)], line_number, rest);
}

}  // namespace

StageText assemble_stage(const std::string& root_path, const std::string& root_text,
                         const std::vector<std::string>& defines) {
    return Assembler(defines).run(root_path, root_text);
}

std::string translate_log(const std::string& log, const std::vector<std::string>& files) {
    std::string result;
    std::size_t begin = 0;
    while (begin < log.size()) {
        const std::size_t end = std::min(log.find('\n', begin), log.size());
        result += translate_line(std::string_view(log).substr(begin, end - begin), files);
        result += '\n';
        begin = end + 1;
    }
    return result;
}

}  // namespace decalgl::gl
