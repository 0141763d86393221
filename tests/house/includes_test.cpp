// The order of the folders: each may include only folders below it.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "catch.hpp"

namespace {

namespace fs = std::filesystem;
using Folders = std::set<std::string>;

Folders operator+(Folders a, const Folders& b) {
    a.insert(b.begin(), b.end());
    return a;
}

// The folders that each folder may include beside itself.
std::map<std::string, Folders> allowed_includes() {
    std::map<std::string, Folders> may;
    const Folders mesh = {"bounds", "polygonizer/mesh"};
    const Folders polygonizer =
        mesh + Folders{"polygonizer/triage", "polygonizer/octree", "polygonizer/marching_cubes"};
    may["bounds"] = {};
    may["polygonizer/mesh"] = {"bounds"};
    for (const char* method : {"triage", "octree", "marching_cubes"}) may[std::string("polygonizer/") + method] = mesh;
    may["raytracer/util"] = {};
    may["raytracer/simd"] = {"bounds"};
    may["raytracer/model"] = {"bounds", "polygonizer/mesh", "raytracer/util"};
    // The scene reader makes meshes of densities with round parts, to convolve them.
    may["raytracer/scene"] = mesh + Folders{"polygonizer/triage", "raytracer/model", "raytracer/util"};
    may["raytracer/image"] = {"bounds", "raytracer/scene", "raytracer/util"};
    may["raytracer/accel"] = {"bounds", "raytracer/simd", "raytracer/util"};
    may["raytracer/trace"] = {"bounds", "raytracer/accel", "raytracer/simd", "raytracer/util"};
    may["raytracer/render"] = may["raytracer/trace"] + Folders{"raytracer/trace", "raytracer/image", "raytracer/scene"};
    may["raytracer/mesh"] = may["raytracer/render"] + polygonizer + Folders{"raytracer/render"};
    may["raytracer/view"] = may["raytracer/mesh"] + Folders{"raytracer/mesh"};
    may["raytracer/pov"] = {"bounds", "raytracer/image", "raytracer/render", "raytracer/scene", "raytracer/util"};
    may["raytracer/cli"] =
        may["raytracer/mesh"] + Folders{"raytracer/mesh", "raytracer/model", "raytracer/pov", "raytracer/view"};
    return may;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

}  // namespace

TEST_CASE("A folder includes only what stands below it") {
    const fs::path root = DEBURR_SOURCE_DIR;
    const auto may = allowed_includes();
    const std::regex include("#include \"([^\"]+)\"");
    int includes = 0;
    for (const char* top : {"bounds", "polygonizer", "raytracer"})
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            const std::string name = fs::relative(entry.path(), root).generic_string();
            if (!entry.is_regular_file() || name == "raytracer/main.cpp") continue;  // includes all commands
            INFO(name);
            const auto allowed = may.find(folder_of(name));
            REQUIRE(allowed != may.end());
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                ++includes;
                const std::string to = folder_of(match[1]);
                INFO(line);
                CHECK((to == allowed->first || allowed->second.count(to) == 1));
            }
        }
    CHECK(includes > 500);
}
