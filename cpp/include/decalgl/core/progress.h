#pragma once

// Progress and cancelling of long work. Callbacks run on the thread that called into the library.

#include <functional>
#include <string>
#include <string_view>

namespace decalgl {

/// Told the stage's name and the fraction done, 0 to 1; returning false cancels the work.
using ProgressFn = std::function<bool(std::string_view stage, double fraction)>;

/// One stage of the work, reported to a callback that may be empty.
class Progress {
public:
    Progress() = default;
    Progress(ProgressFn callback, std::string stage);

    /// Reports a fraction (clamped to 0..1, never going back) and throws Error(cancelled) when told to stop.
    void report(double fraction);

    /// A later stage of the same work, with the same callback.
    Progress stage(std::string name) const;

private:
    ProgressFn callback_;
    std::string stage_;
    double last_ = 0.0;
};

}  // namespace decalgl
