// Includes Catch2 of whichever major version, 2 or 3, is installed.
#pragma once
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;  // version 2 has it in the global namespace
#else
#include <catch2/catch.hpp>
#endif

namespace deburr::test {

/// Factor for the time limits of tests: sanitizers and the fuzzers' edge counting slow programs down.
constexpr double slowness = DEBURR_IS_SANITIZED ? 5 : 1;

}  // namespace deburr::test
