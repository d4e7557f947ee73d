// The test runner; compiled once, since Catch's own code takes longest.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
