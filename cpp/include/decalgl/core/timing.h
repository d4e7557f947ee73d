#pragma once

// Wall-clock times of named passes.

#include <chrono>
#include <string>
#include <vector>

namespace decalgl {

/// Starts when made.
class Stopwatch {
public:
    Stopwatch() : start_(std::chrono::steady_clock::now()) {}

    /// Milliseconds since it was made or last restarted.
    double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

    void restart() { start_ = std::chrono::steady_clock::now(); }

private:
    std::chrono::steady_clock::time_point start_;
};

struct TimedPass {
    std::string name;
    double ms = 0.0;
};

/// What one frame or one preprocessing run cost, pass by pass, in the order the passes ended.
class TimingLog {
public:
    /// `profiling` asks the GL passes to wait for the driver, so that each pass is charged its own time.
    explicit TimingLog(bool profiling = false) : profiling_(profiling) {}

    bool profiling() const { return profiling_; }
    void add(std::string name, double ms) { passes_.push_back({std::move(name), ms}); }
    void clear() { passes_.clear(); }

    const std::vector<TimedPass>& passes() const { return passes_; }
    double total() const;

    /// The sum over passes of one name, 0 where there is none.
    double total(const std::string& name) const;

private:
    bool profiling_ = false;
    std::vector<TimedPass> passes_;
};

}  // namespace decalgl
