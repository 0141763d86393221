// Text that programs print, looked through by tests.
#pragma once
#include <string>

namespace deburr::test {

/// True if `part` is somewhere in the text.
inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace deburr::test
