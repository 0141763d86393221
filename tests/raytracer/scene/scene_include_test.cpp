// include(): files of the scene's folder, their errors, and its limits.
#include <filesystem>

#include "catch.hpp"
#include "raytracer/program.hpp"
#include "raytracer/scene/scene_reader.hpp"

using namespace deburr;
using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

// A scene file that includes others of its folder.
struct IncludingScene {
    Folder folder;
    std::string scene = folder / "s.lua";

    Scene read(const std::string& text) const {
        write_file(scene, text);
        return read_scene(scene);
    }
    std::string error(const std::string& text) const {
        try {
            read(text);
        } catch (const SceneError& error) {
            std::string what = error.what();
            for (std::size_t at; (at = what.find(folder / "")) != std::string::npos;)
                what.erase(at, (folder / "").size());
            return what;
        }
        return "no error";
    }
};

}  // namespace

TEST_CASE("include gives what a file of the scene's folder returns, and runs it once") {
    const IncludingScene place;
    write_file(place.folder / "part.lua",
               "return { post = function(h) return box({0, 0, 0}, {1, h, 1}) end, r = 0.125 }");
    const Scene scene = place.read(
        "local part, again = include('part.lua'), include('part.lua')\n"
        "assert(rawequal(part, again))\n"
        "return { solids = { rounded(part.r, part.post(3)) } }");
    CHECK(scene.solids.at(0).node().radius() == 0.125);
    CHECK(scene.model_files == std::vector<std::string>{place.folder / "part.lua"});

    fs::create_directory(place.folder / "below");
    write_file(place.folder / "below/inner.lua", "#!/usr/bin/lua\nreturn include('part.lua').r, 5");
    CHECK(place.read("return { solids = { rounded(include('below/inner.lua'), cube()) } }")
              .solids.at(0)
              .node()
              .radius() == 0.125);
    write_file(place.folder / "none.lua", "");
    CHECK(place.error(
              "assert(include('none.lua') == nil and include('none.lua') == nil)\nreturn { solids = { cube() } }") ==
          "no error");
    write_file(place.folder / "param.lua", "return param('r', 0.25)");
    CHECK(place.read("return { solids = { rounded(include('param.lua'), cube()) } }").parameters.count("r") == 1);
    write_file(place.folder / "length.lua", "local t = { 1, 2, nil, 4 } return #{ 1, 2, 3 }");
    CHECK(place.error("assert(include('length.lua') == 3)\nreturn { solids = { cube() } }") == "no error");
}

TEST_CASE("an error in an included file names it and its line") {
    const IncludingScene place;
    write_file(place.folder / "part.lua",
               "local a = 1\nreturn {\n  half = function() return halfspace({0, 0, 0}, 1) end }");
    CHECK(place.error("\n\nlocal part = include('part.lua')\nreturn { solids = { part.half() } }") ==
          "part.lua:3: halfspace: normal: expected a direction other than {0, 0, 0}, got {0, 0, 0}");
    write_file(place.folder / "syntax.lua", "local a =\n\n= 1");
    CHECK(place.error("\n\ninclude('syntax.lua')").rfind("syntax.lua:3: ", 0) == 0);
    write_file(place.folder / "runtime.lua", "\nerror('bad')");
    CHECK(place.error("include('runtime.lua')") == "runtime.lua:2: bad");
    CHECK(place.error("include('runtime.lua')\n").rfind("runtime.lua:2: bad", 0) == 0);
    // Errors in the scene itself keep their line numbers.
    CHECK(place.error("local p = include('part.lua')\nerror('here')") == "s.lua:2: here");
}

TEST_CASE("a solid of an included file keeps its place") {
    const Folder folder;
    write_file(folder / "part.lua", "\n\nreturn rounded(9, cube())");
    write_file(folder / "s.lua", "return { solids = { include('part.lua'), cube() } }");
    const Outcome outcome = run({"info", folder / "s.lua"});
    INFO(outcome.out);
    CHECK(outcome.out.find("part.lua:3: solid 1: it vanishes at radius 9") != std::string::npos);
}

TEST_CASE("include reaches nothing outside of the scene's folder") {
    const IncludingScene place;
    const Folder other;
    write_file(other / "x.lua", "return 1");
    CHECK(place.error("include('" + (other / "x.lua") + "')")
              .find("s.lua:1: include: expected a file in the scene's folder") == 0);
    CHECK(place.error("include('../x.lua')").find("s.lua:1: include: expected a file in the scene's folder") == 0);
    fs::create_symlink(other / "x.lua", place.folder / "link.lua");
    CHECK(place.error("include('link.lua')").find("s.lua:1: include: expected a file in the scene's folder") == 0);
    CHECK(place.error("include('gone.lua')").find("found no 'gone.lua' there") != std::string::npos);
    CHECK(place.error("include(5)") == "s.lua:1: include: expected a text, got 5");
    write_file(place.folder / "binary.lua", std::string("a\0b", 3));
    CHECK(place.error("include('binary.lua')").find("expected text, got binary data") != std::string::npos);
    // The included file runs in the same sandbox.
    write_file(place.folder / "io.lua", "return io.open('/etc/passwd')");
    CHECK(place.error("include('io.lua')") == "io.lua:1: io: not available in a scene");
}

TEST_CASE("files that include each other in a ring are told, and limits are shared") {
    const IncludingScene place;
    write_file(place.folder / "a.lua", "return include('b.lua')");
    write_file(place.folder / "b.lua", "\nreturn include('a.lua')");
    CHECK(place.error("include('a.lua')") ==
          "b.lua:2: include: expected a file that is not being read already, got 'a.lua'");
    write_file(place.folder / "self.lua", "return include('s.lua')");
    CHECK(place.error("return include('s.lua')").find("not being read already") != std::string::npos);
    write_file(place.folder / "loop.lua", "while true do end");
    write_file(place.scene, "include('loop.lua')");
    SandboxLimits limits;
    limits.work = 10'000'000;
    CHECK_THROWS_WITH(read_scene(place.scene, {}, limits),
                      (place.folder / "loop.lua") +
                          ":1: expected a scene that ends within 10000000 instructions, got one that does not");
}
