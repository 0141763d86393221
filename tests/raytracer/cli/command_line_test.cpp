// The command line as a user sees it: messages, exit codes and files.
#include "catch.hpp"
#include "raytracer/cli/scene_folder.hpp"
#include "raytracer/picture_file.hpp"

using namespace deburr::test;

TEST_CASE("help and version go to the standard output and are no error") {
    for (const Words& words : {Words{"--help"}, Words{"-h"}, Words{"render", "--help"}, Words{"info", "-h"}}) {
        const Outcome o = run(words);
        CHECK(o.code == 0);
        CHECK(o.out.find("--help") != std::string::npos);
        CHECK(o.err.empty());
    }
    CHECK(run({"--version"}).out == "deburr " DEBURR_VERSION "\n");
}

TEST_CASE("a wrong call is one line and exit code 2, and nothing is written") {
    const SceneFolder place;
    const std::string& scene = place.scene;
    const std::string output = place / "a.exr";
    const std::pair<Words, std::string> table[] = {
        {{}, "expected a command: render"},
        {{"rendr", scene}, "unknown command 'rendr', did you mean render? (see deburr --help)"},
        {{"--foo"}, "unknown option '--foo' (see deburr --help)"},
        {{"render"}, "render: expected a scene file"},
        {{"info"}, "expected a scene file"},
        {{"render", scene}, "render: expected an output file, -o FILE"},
        {{"render", scene, "-o"}, "expected a value, got none"},
        {{"render", scene, "-o", output, "--foo"}, "unknown option '--foo' (see deburr render --help)"},
        {{"render", scene, "-o", output, "--foo=3"}, "unknown option '--foo' (see deburr render --help)"},
        {{"render", scene, "b.lua", "-o", output}, "unexpected argument 'b.lua' (see deburr render --help)"},
        {{"render", scene, "-o", place / "a.foo"}, "-o: expected a file name that ends in .exr"},
        {{"render", scene, "-o", place / "a"}, "-o: expected a file name that ends in .exr"},
        {{"render", scene, "-o", output, "-o", output}, "expected different files, got"},
        {{"render", scene, "-o", output, "--stats-json", output}, "expected different files, got"},
        {{"render", place / "no.lua", "-o", output}, "no.lua: expected a scene, got: No such file or directory"},
        {{"render", place / ".", "-o", output}, ".: expected a scene, got a directory"},
        {{"render", scene, "-o", output, "--size", "0x0"}, "--size: expected WxH, each from 1 to 1000000, got '0x0'"},
        {{"render", scene, "-o", output, "--size", "-5x5"}, "--size: expected WxH, each from 1 to 1000000, got '-5x5'"},
        {{"render", scene, "-o", output, "--size", "65536x65536"}, "--size: expected at most 268435456 pixels"},
        {{"render", scene, "-o", output, "--size"}, "--size: expected a value, got none"},
        {{"render", scene, "-o", output, "--crop", "61x1+0+0"},
         "--crop: expected a window within the picture of 60x40, got '61x1+0+0'"},
        {{"render", scene, "-o", output, "--crop", "9x9"},
         "--crop: expected WxH+X+Y, for example 100x50+20+10, got '9x9'"},
        {{"render", scene, "-o", output, "--size", "5x5", "--crop", "9x9+0+0"}, "within the picture of 5x5"},
        {{"render", scene, "-o", output, "--spp", "0"}, "--spp: expected a whole number from 1 to 1048576, got '0'"},
        {{"render", scene, "-o", output, "--spp", "-1"}, "--spp: expected a whole number from 1 to 1048576, got '-1'"},
        {{"render", scene, "-o", output, "--spp", "1", "--spp", "2"}, "--spp: expected once"},
        {{"render", scene, "-o", output, "--threads", "0"},
         "--threads: expected a whole number from 1 to 1024, got '0'"},
        {{"render", scene, "-o", output, "--seed", "-1"}, "--seed: expected a whole number from 0 to 2^64-1, got '-1'"},
        {{"render", scene, "-o", output, "--aov", "P,Q"},
         "--aov: expected some of P, N, Z, albedo, normal, id, cost, crypto, got 'Q'"},
        {{"render", scene, "-o", place / "a.png", "--aov", "P"},
         "--aov: expected an output that ends in .exr, got none"},
        {{"render", scene, "-o", place / "a.png", "--float"},
         "--float: expected an output that ends in .exr, got none"},
        {{"render", scene, "-o", output, "--via", "magic"}, "--via: expected implicit"},
        {{"render", scene, "-o", output, "--criterion", "x"}, "--criterion: expected exact or lobb, got 'x'"},
        {{"render", scene, "-o", output, "--accel", "kd"}, "--accel: expected bvh or embree, got 'kd'"},
        {{"render", scene, "-o", output, "--accel", "embree", "--via", "triage"},
         "--accel: expected --via implicit, got 'triage'"},
        {{"render", scene, "-o", output, "--quiet=foo"}, "--quiet: expected no value, got 'foo'"},
        {{"render", scene, "-o", output, "--bits", "16"}, "--bits: expected an output that ends in .png, got none"},
        {{"render", scene, "-o", place / "a.png", "--bits", "12"}, "--bits: expected 8 or 16, got '12'"},
        {{"render", scene, "-o", place / "a.jpg", "--alpha"},
         "--alpha: expected outputs that end in .exr or .png, got"},
        {{"render", scene, "-o", output, "--stats-json", scene}, "outputs: expected other files than the input"},
        {{"mesh", scene, "--stats-json", scene}, "outputs: expected other files than the input"},
        {{"compare", scene, scene, "--json", scene}, "outputs: expected other files than the input"},
        {{"mesh", scene, "-o", place / "a.stl", "--stats-json", place / "a.stl"}, "expected different files, got"},
        {{"info", "--", "-a.lua", "-b.lua"}, "unexpected argument '-b.lua' (see deburr info --help)"},
        {{"render", scene, "-o", output, "-D", "r"}, "-D: expected name=value, got 'r'"},
        {{"render", scene, "-o", output, "-D", "rr=3"}, "rr"},
        {{"render", scene, "-o", output, "-D", "r=-1"}, "cube.lua:"},
    };
    for (const auto& [words, message] : table) {
        const Outcome o = run(words);
        CAPTURE(words, message, o.err);
        CHECK(o.code == 2);
        CHECK(one_line(o.err));
        CHECK(o.err.rfind("deburr: ", 0) == 0);
        CHECK(o.err.find(message) != std::string::npos);
        CHECK(o.out.empty());
    }
    CHECK(place.names() == Words{"cube.lua"});
}

TEST_CASE("-- ends the options") {
    const SceneFolder place;
    write_file(place / "-a.lua", cube_scene());
    const std::string in = "cd '" + place / "" + "' && '" DEBURR_PROGRAM "' ";
    for (const char* call :
         {"info -- -a.lua >/dev/null", "info -- ./cube.lua >/dev/null", "render -q -o a.png -- -a.lua",
          "render -q -o a.png cube.lua --", "compare -q -- a.png a.png"}) {
        CAPTURE(call);
        CHECK(WEXITSTATUS(std::system((in + call).c_str())) == 0);
    }
}

TEST_CASE("placements that are singular only together are one line with the solid's place") {
    const SceneFolder place;
    for (const std::string chain : {"d:scale(1e-90)", "d:scale(1e90)", "d:scale(1e-90, 1e90, 1)"}) {
        const std::string scene = place / "chain.lua";
        write_file(scene, "local d = cube()\nfor i = 1, 5 do d = " + chain +
                              " end\nreturn { camera = { eye = {3, 3, 4}, target = {0, 0, 0} },\n"
                              "  solids = { rounded(0.1, d) } }\n");
        const Outcome o = run({"render", scene, "-o", place / "a.exr"});
        CAPTURE(chain, o.err);
        CHECK(o.code == 2);
        CHECK(o.err == "deburr: " + scene +
                           ":4: expected placements that leave a volume, got scales "
                           "that multiply to 0 or infinity\n");
    }
    CHECK(place.names() == Words{"chain.lua", "cube.lua"});
}

TEST_CASE("a wrong SOURCE_DATE_EPOCH is said") {
    const SceneFolder place;
    const Outcome o = run(place.render({}), {"SOURCE_DATE_EPOCH=yesterday"});
    CHECK(o.code == 2);
    CHECK(o.err.find("SOURCE_DATE_EPOCH: expected a whole number") != std::string::npos);
}

TEST_CASE("outputs that cannot be written are found before the work: exit code 1") {
    const SceneFolder place;
    for (const std::string name : {"none/a.exr", "cube.lua/a.exr"}) {
        // So much work that the test would not end if it were begun.
        const Outcome o = run(place.render({"--size", "8000x8000", "--spp", "100000"}, name));
        CHECK(o.code == 1);
        CHECK(one_line(o.err));
        CHECK(o.err.rfind("deburr: cannot write '", 0) == 0);
    }
    CHECK(place.names() == Words{"cube.lua"});
}

TEST_CASE("without room a picture is not written, and what was there stays") {
    const SceneFolder place;
    write_file(place / "a.exr", "old");
    // A limit on the size of files, in blocks of 512 bytes, stands for a full disk.
    const std::string command = "ulimit -f 1; exec '" DEBURR_PROGRAM "' render '" + place.scene +
                                "' -q --float --aov P,N -o '" + place / "a.exr" + "' 2>'" + place / "err" + "'";
    const int status = std::system(("sh -c \"" + command + "\"").c_str());
    CHECK(WEXITSTATUS(status) == 1);
    CHECK(one_line(read_file(place / "err")));
    CHECK(read_file(place / "err").find("File too large") != std::string::npos);
    CHECK(read_file(place / "a.exr") == "old");
    CHECK(place.names() == Words{"a.exr", "cube.lua", "err"});
}

TEST_CASE("where nobody can read the messages the exit code and the files are the same") {
    const SceneFolder place;
    const std::string program = "'" DEBURR_PROGRAM "' ", output = " -o '" + place / "a.exr" + "' ";
    for (const std::string away : {"2>&-", "2>/dev/full", "<&- >&- 2>&-"}) {
        CAPTURE(away);
        CHECK(WEXITSTATUS(std::system((program + "--foo " + away).c_str())) == 2);
        const std::string call = program + "render -v '" + place.scene + "'" + output + away;
        CHECK(WEXITSTATUS(std::system(call.c_str())) == 0);
        CHECK(read_back(place / "a.exr").width == 60);
    }
    CHECK(WEXITSTATUS(std::system((program + "info '" + place.scene + "' >/dev/full 2>/dev/null").c_str())) == 1);
}

TEST_CASE("statistics on a full device: exit code 1") {
    const SceneFolder place;
    CHECK(run(place.render({"--stats-json", "/dev/full"})).code == 1);
}

TEST_CASE("compare takes a crop") {
    const SceneFolder place;
    const Outcome o = run({"compare", place.scene, "--size", "30000x30000", "--crop", "20x10+15000+15000"});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.out.find("pixels              200\n") != std::string::npos);
}

TEST_CASE("a scene is read once, so that it may come from a pipe") {
    const SceneFolder place;
    const auto shell = [](const std::string& command) {
        return WEXITSTATUS(std::system(("bash -c \"" + command + "\"").c_str()));
    };
    const std::string program = "'" DEBURR_PROGRAM "' ", output = " -q -o '" + place / "a.png" + "'";
    CHECK(shell("cat '" + place.scene + "' | " + program + "render /dev/stdin" + output) == 0);
    CHECK(read_back(place / "a.png").width == 60);
    CHECK(shell(program + "render <(cat '" + place.scene + "')" + output + " -D r=0.2") == 0);
    CHECK(shell("mkfifo '" + place / "fifo" + "'; cat '" + place.scene + "' > '" + place / "fifo" + "' & " + program +
                "info '" + place / "fifo" + "' > '" + place / "out" + "'") == 0);
    CHECK(read_file(place / "out").find("60x40") != std::string::npos);
    CHECK(shell(program + "info /dev/stdin < '" + place.scene + "' > /dev/null") == 0);
    CHECK(shell(program + "info /dev/null 2> '" + place / "err" + "'") == 2);
    CHECK(read_file(place / "err").find("deburr: /dev/null: scene: expected the chunk to return") == 0);
}

TEST_CASE("a scene that prints without an end stops at a limit") {
    const SceneFolder place;
    write_file(place / "p.lua", "local s = ('a'):rep(2^10) while true do pcall(print, s) end");
    const Outcome o = run({"info", place / "p.lua"});
    CHECK(o.code == 2);
    CHECK(o.err.size() < (1 << 20) + 300);
    const std::string last = o.err.substr(o.err.rfind('\n', o.err.size() - 2) + 1);
    CHECK(last == "deburr: " + place / "p.lua" +
                      ":1: expected a scene that prints at most 1048576 bytes, got one that prints more\n");
}

TEST_CASE("a density that is too entangled to be evaluated is not supported, and soon told") {
    // Pairs of half-spaces in the worst order: each pair doubles the decision diagram.
    const SceneFolder place;
    write_file(place / "e.lua",
               "local x, every, pairs_of\n"
               "local first = {}\n"
               "for i = 1, 22 do\n"
               "  x = halfspace({math.cos(i), math.sin(i), 0.1 * i - 1}, 0.3)\n"
               "  first[i], every = x, every and every & x or x\n"
               "end\n"
               "for i = 1, 22 do\n"
               "  local y = halfspace({math.cos(0.7 * i + 0.2), math.sin(1.3 * i), 0.1 * i - 1}, 0.3)\n"
               "  local both = first[i] & y\n"
               "  pairs_of = pairs_of and pairs_of | both or both\n"
               "end\n"
               "return { solids = {\n"
               "  rounded(2, (every | pairs_of) & box({-1, -1, -1}, {1, 1, 1})) } }\n");
    const Outcome o = run({"render", place / "e.lua", "-o", place / "e.exr", "--size", "8x8"});
    CHECK(o.code == 3);
    CHECK(o.err.find("the solid of line 13: expected a Boolean density whose decision diagram") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(place / "e.exr"));
}
