#pragma once

// The GL functions: one table for the process, filled by Context::make_current.

#include <glad/gl.h>
