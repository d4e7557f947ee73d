// Choices of a technique written one after the other, as bytes: equal ones write equal bytes, so that a saved scene tells
// whether it was made with the same.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace decalgl {

class ChoiceBytes {
public:
    template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>>>
    void add(T value) {
        const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
    }

    void add(const std::string& text) {
        add(text.size());
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }

    template <typename T, std::size_t count>
    void add(const std::array<T, count>& values) {
        for (const T& value : values)
            add(value);
    }

    // With its length, so that it is known where the next one begins.
    template <typename T>
    void add(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values)
            add(value);
    }

    template <typename... T>
    void add(const std::tuple<T...>& values) {
        std::apply([this](const auto&... each) { (add(each), ...); }, values);
    }

    const std::vector<uint8_t>& bytes() const { return bytes_; }

private:
    std::vector<uint8_t> bytes_;
};

}  // namespace decalgl
