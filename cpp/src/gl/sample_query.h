#pragma once

// How many samples are drawn.

#include <cstdint>

#include "gl/object.h"

namespace decalgl::gl {

/// Counts the samples that pass all tests from here on until it is asked or ends; one at a time.
class SampleQuery {
public:
    SampleQuery();
    ~SampleQuery();
    SampleQuery(const SampleQuery&) = delete;
    SampleQuery& operator=(const SampleQuery&) = delete;

    /// Ends counting, and waits for the driver.
    uint64_t count();

private:
    ObjectHandle query_;
    bool counting_ = true;
};

}  // namespace decalgl::gl
