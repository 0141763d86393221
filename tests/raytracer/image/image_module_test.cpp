// Large libraries are loaded only by calls that need them.
#include "raytracer/image/image_module.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// The names of the large libraries that this call loads.
std::string loaded(const std::vector<std::string>& words) {
    const Outcome outcome = run(words, {"LD_DEBUG=files"});  // makes the loader print every file that it opens
    CAPTURE(words);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.find("libpng") != std::string::npos);
    std::string names;
#if DEBURR_IS_SANITIZED
    const std::vector<const char*> libraries{"OpenEXR", "OpenImageIO"};  // builds with sanitizers link Embree
#else
    const std::vector<const char*> libraries{"OpenEXR", "OpenImageIO", "embree"};
#endif
    for (const char* library : libraries)
        if (outcome.err.find(std::string("lib") + library) != std::string::npos)
            names += std::string(names.empty() ? "" : " ") + library;
    return names;
}

}  // namespace

TEST_CASE("only what needs OpenEXR, OpenImageIO or Embree loads it") {
    const Folder folder;
    const std::string scene = folder / "cube.lua";
    write_file(scene, cube_scene());
    CHECK(loaded({"--help"}) == "");
    CHECK(loaded({"info", scene}) == "");
    CHECK(loaded({"mesh", scene, "-q", "-o", folder / "a.stl"}) == "");
    CHECK(loaded({"render", scene, "-q", "-o", folder / "a.png"}) == "");
    CHECK(loaded({"render", scene, "-q", "-o", folder / "a.exr", "-o", folder / "a.png"}) == "OpenEXR");
    CHECK(loaded({"render", scene, "-q", "-o", folder / "a.jpg"}) == "OpenEXR OpenImageIO");  // it needs OpenEXR too
#if !DEBURR_IS_SANITIZED
    CHECK(loaded({"render", scene, "-q", "-o", folder / "a.png", "--via", "triage"}) == "embree");
    CHECK(loaded({"render", scene, "-q", "-o", folder / "a.png", "--accel", "embree"}) == "embree");
#endif
    CHECK(loaded({"compare", folder / "a.exr", folder / "a.png", "-q"}) == "OpenEXR OpenImageIO");
}

TEST_CASE("a missing module is one clear line, before any work") {
    const Folder folder;
    write_file(folder / "cube.lua", cube_scene());
    std::filesystem::copy_file(DEBURR_PROGRAM, folder / "deburr");
    const auto call = [&](const std::string& output) {
        const std::string command =
            "cd '" + (folder / "") + "' && ./deburr render cube.lua -q -o " + output + " 2> errors";
        return WEXITSTATUS(std::system(command.c_str()));
    };
    for (const auto& [output, says] :
         {std::pair{"a.jpg", "pictures other than EXR and PNG need deburr_images.so: expected in '"},
          {"a.exr", "EXR pictures need deburr_exr.so: expected in '"}}) {
        CHECK(call(output) == 3);
        const std::string error = read_file(folder / "errors");
        CHECK(error.find(says) != std::string::npos);
        CHECK(std::count(error.begin(), error.end(), '\n') == 1);
    }
    CHECK(call("a.png") == 0);
}
