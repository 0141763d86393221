// A folder with a scene, for tests that run the program.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "catch.hpp"
#include "raytracer/program.hpp"

namespace deburr::test {

using Words = std::vector<std::string>;

struct SceneFolder : Folder {
    std::string scene = *this / "cube.lua";
    SceneFolder() { write_file(scene, cube_scene()); }

    Words render(const Words& more, const std::string& output = "a.exr") const {
        Words words = {"render", scene, "-o", *this / output, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

inline bool one_line(const std::string& text) {
    return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

}  // namespace deburr::test
