// Runs the program gnuplot.
#pragma once
#include <string>

namespace deburr {

/// The bytes of the picture that `script` draws; `terminal` is the line that sets gnuplot's terminal. Throws
/// UnsupportedError if gnuplot is not installed, and WorkError with its message if it fails.
std::string run_gnuplot(const std::string& terminal, const std::string& script);

}  // namespace deburr
