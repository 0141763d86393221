// Hints for scenes that use words of other modelling languages.
#pragma once
#include <string_view>

namespace deburr {

/// The end of the message about an unknown name, such as "; write a | b" for `union`; "" if there is no hint.
const char* instead_of_name(std::string_view name);

/// The end of the message about a syntax error; "" if there is no hint.
const char* instead_of_syntax(std::string_view message);

}  // namespace deburr
