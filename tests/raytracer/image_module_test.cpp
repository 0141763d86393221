// OpenImageIO is loaded where it is needed and nowhere else.
#include "raytracer/image_module.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

bool loads_openimageio(const std::vector<std::string>& words) {
    const Outcome outcome = run(words, {"LD_DEBUG=files"});  // the loader names every file it opens
    CAPTURE(words);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.find("libOpenEXR") != std::string::npos);
    return outcome.err.find("libOpenImageIO") != std::string::npos;
}

}  // namespace

TEST_CASE("only what needs OpenImageIO loads it") {
    const Folder folder;
    const std::string scene = folder / "cube.lua";
    write_file(scene, cube_scene());
    CHECK_FALSE(loads_openimageio({"--help"}));
    CHECK_FALSE(loads_openimageio({"info", scene}));
    CHECK_FALSE(loads_openimageio({"mesh", scene, "-q", "-o", folder / "a.stl"}));
    CHECK_FALSE(loads_openimageio({"render", scene, "-q", "-o", folder / "a.exr", "-o", folder / "a.png"}));
    CHECK(loads_openimageio({"render", scene, "-q", "-o", folder / "a.jpg"}));
    CHECK(loads_openimageio({"compare", folder / "a.exr", folder / "a.png", "-q"}));
}

TEST_CASE("a missing module is one clear line, before any work") {
    const Folder folder;
    write_file(folder / "cube.lua", cube_scene());
    std::filesystem::copy_file(DEBURR_PROGRAM, folder / "deburr");
    const auto call = [&](const std::string& output) {
        const std::string command = "cd '" + (folder / "") + "' && ./deburr render cube.lua -q -o " + output + " 2> errors";
        return WEXITSTATUS(std::system(command.c_str()));
    };
    CHECK(call("a.jpg") == 3);
    const std::string error = read_file(folder / "errors");
    CHECK(error.find("pictures other than EXR and PNG need deburr_images.so: expected in '") != std::string::npos);
    CHECK(std::count(error.begin(), error.end(), '\n') == 1);
    CHECK(call("a.png") == 0);
}
