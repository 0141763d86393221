// What to write where a scene uses words of other languages for models.
#pragma once
#include <string_view>

namespace deburr {

/// A half-sentence for the message that a name is not known, "; write a | b" for `union`; empty where there is none.
const char* instead_of_name(std::string_view name);

/// The same for the message of a syntax error.
const char* instead_of_syntax(std::string_view message);

}  // namespace deburr
