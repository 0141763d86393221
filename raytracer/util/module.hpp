// Loads code when it is first needed: modules, which are the program's own shared objects that call a large library,
// and system libraries that are called directly. Linking such a library would add its load time to every run: 1.5 ms
// for OpenEXR; for OpenImageIO, with the 250 libraries it depends on, longer than most pictures take.
#pragma once
#include <string>

namespace deburr {

/// Returns the function `name` of the module `file`, which is loaded on the first call. Throws UnsupportedError if that
/// fails; the message says that `what` needs it.
void* module_function(const std::string& file, const char* name, const std::string& what);

/// Throws std::bad_alloc if the loader's error message says that memory was lacking.
void check_loader_memory(const std::string& error);

/// module_function() with the function's type.
template <class Function>
Function* module_function(const std::string& file, const char* name, const std::string& what) {
    return reinterpret_cast<Function*>(module_function(file, name, what));
}

/// A shared library of the system. It is never unloaded.
class SystemLibrary {
public:
    /// Loads the library. Throws UnsupportedError if the loader fails, with a message of `needed` (such as "pictures
    /// need"), `file` and the reason.
    SystemLibrary(std::string file, std::string needed);

    /// Sets `function`, a pointer to a function, to the library's function of this name. Throws UnsupportedError if
    /// there is none.
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
