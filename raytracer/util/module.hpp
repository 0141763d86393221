// Modules: shared objects of ours, beside the program, with the code that calls a large library. A
// library that is linked costs every call its loading; OpenEXR 1.5 ms, OpenImageIO, with the 250
// that it depends on, longer than most pictures take.
#pragma once
#include <string>

namespace deburr {

/// The function of a module's file that has this name, loaded when it is first asked for. Throws
/// UnsupportedError, which says `what` needs it, if it cannot be.
void* module_function(const std::string& file, const char* name, const std::string& what);

/// The same, typed.
template <class Function>
Function* module_function(const std::string& file, const char* name, const std::string& what) {
    return reinterpret_cast<Function*>(module_function(file, name, what));
}

}  // namespace deburr
