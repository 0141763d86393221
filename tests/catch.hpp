// Catch2, whichever of its two major versions the system has.
#pragma once
#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;  // as in version 2
#else
#include <catch2/catch.hpp>
#endif

namespace deburr::test {

/// What a test's limit of time is multiplied by: sanitizers, and the counting of edges for fuzzers, slow programs down.
constexpr double slowness = DEBURR_IS_SANITIZED ? 5 : 1;

}  // namespace deburr::test
