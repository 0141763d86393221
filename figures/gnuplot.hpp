// The program gnuplot, as a function from its language to a picture.
#pragma once
#include <string>

namespace deburr {

/// The bytes of what `script` draws on `terminal` (a line that sets one). Throws UnsupportedError if
/// there is no gnuplot, WorkError with its message if it fails.
std::string run_gnuplot(const std::string& terminal, const std::string& script);

}  // namespace deburr
