#include "raytracer/util/module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <new>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// Folders relative to the program's own: the same, the one above (for programs of tests and benchmarks), and the
// installed one.
constexpr const char* folders[] = {"", "..", DEBURR_MODULE_FOLDER};

}  // namespace

void check_loader_memory(const std::string& error) {
    for (const char* words :
         {"failed to map segment", "annot allocate memory", "cannot create shared object descriptor",
          "cannot map zero-fill pages", "cannot create scope"})
        if (error.find(words) != std::string::npos) throw std::bad_alloc();
}

void* module_function(const std::string& file, const char* name, const std::string& what) {
    namespace fs = std::filesystem;
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
    fs::path found;
    for (const char* folder : folders) {
        const fs::path path = program / folder / file;
        if (found.empty() && fs::exists(path, none)) found = path;
    }
    const auto fail = [&](const std::string& why) {
        check_loader_memory(why);
        throw UnsupportedError(what + " need " + file + ": " + why);
    };
    if (found.empty())
        fail(fmt::format("expected in '{}' or '{}', not found", program.string(),
                         (program / DEBURR_MODULE_FOLDER).lexically_normal().string()));
    void* module = dlopen(found.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module) fail(dlerror());
    void* function = dlsym(module, name);
    if (!function) fail(dlerror());
    return function;
}

SystemLibrary::SystemLibrary(std::string file, std::string needed)
    : file_(std::move(file)), needed_(std::move(needed)), library_(dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!library_) fail();
}

void* SystemLibrary::address(const char* name) const {
    void* found = dlsym(library_, name);
    if (!found) fail();
    return found;
}

void SystemLibrary::fail() const {
    const std::string why = dlerror();
    check_loader_memory(why);
    throw UnsupportedError(fmt::format("{} {}: {}", needed_, file_, why));
}

}  // namespace deburr
