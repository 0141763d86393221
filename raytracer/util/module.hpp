// Modules: shared objects of ours, beside the program, with the code that calls a large library.
// Linking such a library would add its load time to every run: OpenEXR 1.5 ms; OpenImageIO, with the
// 250 that it depends on, longer than most pictures take.
#pragma once
#include <string>

namespace deburr {

/// The function of a module's file that has this name, loaded when it is first asked for. Throws
/// UnsupportedError, which says `what` needs it, if it cannot be.
void* module_function(const std::string& file, const char* name, const std::string& what);

/// Throws std::bad_alloc if the loader says, in words of its own, that memory is what it lacks.
void check_loader_memory(const std::string& error);

/// module_function with the function's type.
template <class Function>
Function* module_function(const std::string& file, const char* name, const std::string& what) {
    return reinterpret_cast<Function*>(module_function(file, name, what));
}

}  // namespace deburr
