// Code that is loaded when it is first needed: modules, which are shared objects of ours beside the program with the
// code that calls a large library, and libraries of the system that we call ourselves. Linking such a library would add
// its load time to every run: OpenEXR 1.5 ms; OpenImageIO, with the 250 that it depends on, longer than most pictures
// take.
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

/// A shared library of the system. It stays loaded.
class SystemLibrary {
public:
    /// Throws UnsupportedError if the loader does not find it: `needed`, such as "pictures need", `file`, and why.
    SystemLibrary(std::string file, std::string needed);

    /// Sets `function`, a pointer to a function, to the one of this name. Throws UnsupportedError if the library has
    /// none.
    template <class Pointer>
    void find(Pointer& function, const char* name) const {
        function = reinterpret_cast<Pointer>(address(name));
    }

private:
    void* address(const char* name) const;
    [[noreturn]] void fail() const;

    std::string file_, needed_;
    void* library_;
};

}  // namespace deburr
