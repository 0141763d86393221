// The program as a user calls it: messages, exit codes, files.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
using Words = std::vector<std::string>;

namespace {

// A folder with a scene in it.
struct Place : Folder {
    std::string scene = *this / "cube.lua";
    Place() { write_file(scene, cube_scene()); }

    Words render(const Words& more, const std::string& output = "a.exr") const {
        Words words = {"render", scene, "-o", *this / output, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
};

bool one_line(const std::string& text) {
    return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

// Values of all channels, and where they are.
struct Picture {
    OIIO::ImageSpec spec;
    std::vector<unsigned char> bytes;  // as in the file
    std::size_t pixel = 0;

    explicit Picture(const std::string& path) {
        const auto input = OIIO::ImageInput::open(path);
        REQUIRE(input);
        spec = input->spec();
        pixel = spec.pixel_bytes(true);
        bytes.resize(spec.image_bytes(true));
        REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UNKNOWN, bytes.data()));
    }
    const unsigned char* at(int x, int y) const {
        return bytes.data() + (std::size_t(y - spec.y) * std::size_t(spec.width) + std::size_t(x - spec.x)) * pixel;
    }
};

}  // namespace

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
    const Place place;
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
         "--aov: expected some of P, N, Z, albedo, id, cost, crypto, got 'Q'"},
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
    const Place place;
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
    const Place place;
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
    const Place place;
    const Outcome o = run(place.render({}), {"SOURCE_DATE_EPOCH=yesterday"});
    CHECK(o.code == 2);
    CHECK(o.err.find("SOURCE_DATE_EPOCH: expected a whole number") != std::string::npos);
}

TEST_CASE("outputs that cannot be written are found before the work: exit code 1") {
    const Place place;
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
    const Place place;
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
    const Place place;
    const std::string program = "'" DEBURR_PROGRAM "' ", output = " -o '" + place / "a.exr" + "' ";
    for (const std::string away : {"2>&-", "2>/dev/full", "<&- >&- 2>&-"}) {
        CAPTURE(away);
        CHECK(WEXITSTATUS(std::system((program + "--foo " + away).c_str())) == 2);
        const std::string call = program + "render -v '" + place.scene + "'" + output + away;
        CHECK(WEXITSTATUS(std::system(call.c_str())) == 0);
        CHECK(Picture(place / "a.exr").spec.width == 60);
    }
    CHECK(WEXITSTATUS(std::system((program + "info '" + place.scene + "' >/dev/full 2>/dev/null").c_str())) == 1);
}

TEST_CASE("statistics on a full device: exit code 1") {
    const Place place;
    CHECK(run(place.render({"--stats-json", "/dev/full"})).code == 1);
}

TEST_CASE("render writes all outputs, and quiet says nothing") {
    const Place place;
    const Outcome o = run(place.render({"-o", place / "b.png", "-D", "r=0.2"}));
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.err.empty());
    CHECK(o.out.empty());
    CHECK(place.names() == Words{"a.exr", "b.png", "cube.lua"});
    const Picture picture(place / "a.exr");
    CHECK(picture.spec.width == 60);
    CHECK(picture.spec.height == 40);
    CHECK(picture.spec.get_string_attribute("deburr.scene") == place.scene);
    CHECK(picture.spec.get_string_attribute("deburr.parameter.r") == "0.2");
    CHECK(picture.spec.get_float_attribute("renderTimeSeconds", -1) >= 0);
    CHECK(Picture(place / "b.png").spec.nchannels == 3);
}

TEST_CASE("elsewhere than on a terminal progress is lines") {
    const Place place;
    const Outcome o = run({"render", place.scene, "-o", place / "a.exr"});
    CHECK(o.code == 0);
    CHECK(o.err.find('\r') == std::string::npos);
    CHECK(o.err.find("100 %") != std::string::npos);
}

TEST_CASE("files are the same to the byte with SOURCE_DATE_EPOCH, whatever the threads", "[threads]") {
    const Place place;
    const Words epoch = {"SOURCE_DATE_EPOCH=1700000000"};
    for (const std::string threads : {"1", "2", "2"}) {
        const Outcome o = run(
            place.render({"-o", place / "a.png", "--spp", "4", "--aov", "P,N,Z,albedo,id,cost", "--threads", threads}),
            epoch);
        REQUIRE(o.code == 0);
        static std::string exr, png;
        if (exr.empty()) {
            exr = read_file(place / "a.exr");
            png = read_file(place / "a.png");
        }
        CHECK(read_file(place / "a.exr") == exr);
        CHECK(read_file(place / "a.png") == png);
    }
    const Picture picture(place / "a.exr");
    CHECK(picture.spec.get_string_attribute("DateTime") == "2023:11:14 22:13:20");
    CHECK_FALSE(picture.spec.find_attribute("renderTimeSeconds"));
}

TEST_CASE("a crop has the bytes of the whole picture") {
    const Place place;
    const Words layers = {"--spp", "3", "--aov", "P,N,Z,albedo,id,cost"};
    REQUIRE(run(place.render(layers)).code == 0);
    const Picture whole(place / "a.exr");
    for (const std::string crop : {"23x17+20+11", "1x1+59+39", "60x1+0+20"}) {
        Words more = layers;
        more.insert(more.end(), {"--crop", crop});
        REQUIRE(run(place.render(more, "part.exr")).code == 0);
        const Picture part(place / "part.exr");
        CHECK(part.spec.full_width == 60);
        CHECK(part.spec.full_height == 40);
        REQUIRE(part.pixel == whole.pixel);
        for (int y = part.spec.y; y < part.spec.y + part.spec.height; ++y)
            for (int x = part.spec.x; x < part.spec.x + part.spec.width; ++x)
                REQUIRE(std::memcmp(part.at(x, y), whole.at(x, y), whole.pixel) == 0);
    }
}

TEST_CASE("crops of a poster that is too large as a whole are rendered, and pasted are the whole") {
    const Place place;
    const Outcome large = run(place.render({"--size", "30000x30000", "--crop", "40x30+14000+16000"}));
    CAPTURE(large.err);
    REQUIRE(large.code == 0);
    const OIIO::ImageSpec spec = Picture(place / "a.exr").spec;
    CHECK(spec.full_width == 30000);
    CHECK(spec.x == 14000);
    CHECK(run(place.render({"--size", "30000x30000", "--crop", "20000x20000+0+0"})).code == 2);
    for (const Words& how : {Words{}, Words{"--via", "triage", "--edges"}, Words{"--alpha", "--bits", "16"}}) {
        Words more = {"--size", "90x60", "--spp", "2"};
        more.insert(more.end(), how.begin(), how.end());
        REQUIRE(run(place.render(more, "whole.png")).code == 0);
        const Picture whole(place / "whole.png");
        int pixels = 0;
        for (int y = 0; y < 60; y += 30)
            for (int x = 0; x < 90; x += 40) {
                Words cut = more;
                const int w = std::min(40, 90 - x);
                cut.insert(cut.end(),
                           {"--crop", std::to_string(w) + "x30+" + std::to_string(x) + "+" + std::to_string(y)});
                REQUIRE(run(place.render(cut, "part.png")).code == 0);
                const Picture part(place / "part.png");
                for (int row = 0; row < 30; ++row)
                    REQUIRE(std::memcmp(part.at(0, row), whole.at(x, y + row), std::size_t(w) * whole.pixel) == 0);
                pixels += 30 * w;
            }
        CHECK(pixels == 90 * 60);
    }
}

TEST_CASE("compare takes a crop") {
    const Place place;
    const Outcome o = run({"compare", place.scene, "--size", "30000x30000", "--crop", "20x10+15000+15000"});
    CAPTURE(o.err);
    CHECK(o.code == 0);
    CHECK(o.out.find("pixels              200\n") != std::string::npos);
}

TEST_CASE("a picture by --accel bvh, under its older name and by embree is the same to the byte, and says by which") {
    const Place place;
    for (const std::string scene : {"csg_examples", "variable_rounding", "staplers"}) {
        CAPTURE(scene);
        std::vector<unsigned char> bytes;
        for (const std::string accel : {"bvh", "bsp", "embree"}) {
            const std::string recorded = accel == "embree" ? accel : "bsp";  // as pictures have always said
            const Outcome o = run(
                {"render", DEBURR_SOURCE_DIR "/scenes/" + scene + ".lua", "-q", "-o", place / "a.exr", "--accel", accel,
                 "--size", "120x80", "--float", "--aov", "P,N,Z,id", "--stats", "--stats-json", place / "s.json"},
                {"SOURCE_DATE_EPOCH=0"});
            REQUIRE(o.code == 0);
            const Picture picture(place / "a.exr");
            CHECK(picture.spec.get_string_attribute("deburr.accel") == recorded);
            CHECK(nlohmann::json::parse(read_file(place / "s.json"))["accel"] == recorded);
            CHECK(o.out.find("accel") != std::string::npos);
            if (bytes.empty()) bytes = picture.bytes;
            CHECK(picture.bytes == bytes);
        }
    }
    REQUIRE(run(place.render({"--via", "triage"})).code == 0);
    CHECK_FALSE(Picture(place / "a.exr").spec.find_attribute("deburr.accel"));
}

TEST_CASE("another seed gives another picture only where there are random samples") {
    const Place place;
    const Words epoch = {"SOURCE_DATE_EPOCH=0"};
    std::vector<std::vector<unsigned char>> bytes;
    for (const Words& more : {Words{"--spp", "1", "--seed", "1"}, Words{"--spp", "1", "--seed", "2"},
                              Words{"--spp", "4", "--seed", "1"}, Words{"--spp", "4", "--seed", "2"}}) {
        REQUIRE(run(place.render(more), epoch).code == 0);
        bytes.push_back(Picture(place / "a.exr").bytes);
    }
    CHECK(bytes[0] == bytes[1]);
    CHECK(bytes[2] != bytes[3]);
}

TEST_CASE("statistics as a table and as JSON") {
    const Place place;
    const Outcome o = run(place.render({"--stats", "--stats-json", place / "s.json", "--threads", "1", "--seed", "7"}));
    REQUIRE(o.code == 0);
    for (const char* word : {"rays", "shadow rays", "splits", "density evaluations", "BSP cells", "60x40"})
        CHECK(o.out.find(word) != std::string::npos);
    const auto j = nlohmann::json::parse(read_file(place / "s.json"));
    CHECK(j["version"] == DEBURR_VERSION);
    CHECK(j["complete"] == true);
    CHECK(j["width"] == 60);
    CHECK(j["threads"] == 1);
    CHECK(j["seed"] == 7);
    CHECK(j["pixels"] == 2400);
    CHECK(j["rays"] >= 2400);
    CHECK(j["bsp"]["cells"] > 0);
    for (const char* phase : {"read", "build", "trace", "write"}) {
        CHECK(j["seconds"][phase]["wall"] >= 0);
        CHECK(j["seconds"][phase]["cpu"] >= 0);
    }
}

TEST_CASE("info counts what a union places, however often it is more than can be laid out") {
    const Place place;
    // Each step doubles the row: 2^24 cubes one after the other, in 100 million half-spaces.
    write_file(place.scene,
               "local a = sharp(cube()) for k = 0, 23 do a = a | a:translate(2^k, 0, 0) end\n"
               "return { solids = { a:rotate(90, {0, 0, 1}), ellipsoid{} | a } }");
    const Outcome o = run({"info", place.scene, "--json"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    const auto j = nlohmann::json::parse(o.out);
    CHECK(j["solids"][0]["half_spaces"] == 6.0 * (1 << 24));
    CHECK(j["solids"][1]["half_spaces"] == 6.0 * (1 << 24));
    CHECK(j["solids"][1]["quadrics"] == 1);
    const auto bounds = j["solids"][0]["bounds"];
    CHECK(std::abs(bounds["lo"][0].get<double>() + 1) < 0.1);
    CHECK(std::abs(bounds["hi"][1].get<double>() - (1 << 24)) < 0.1);
    CHECK(std::abs(bounds["hi"][2].get<double>() - 1) < 0.1);
    // A mesh has triangles of each.
    const Outcome mesh = run({"mesh", place.scene, "-o", place / "a.stl"});
    CHECK(mesh.code == 3);
    CHECK(mesh.err.find("deburr: expected a solid of at most 4000000 half-spaces") == 0);
}

TEST_CASE("info says what is in a scene") {
    const Place place;
    const Outcome o = run({"info", place.scene, "-D", "r=0.3"});
    CHECK(o.code == 0);
    CHECK(o.err.empty());
    for (const char* text : {"60x40", "r = 0.3", "solids        2", "half-spaces   12", "lights        1", "point",
                             "bounds        [-1, 2] x [-1, 1] x [-1, 2]"}) {
        CAPTURE(text, o.out);
        CHECK(o.out.find(text) != std::string::npos);
    }
    const auto j = nlohmann::json::parse(run({"info", "--json", place.scene}).out);
    CHECK(j["solids"].size() == 2);
    CHECK(j["half_spaces"] == 12);
    CHECK(j["quadrics"] == 0);
    CHECK(j["parameters"]["r"] == "0.1");
    CHECK(j["image"]["width"] == 60);
}

TEST_CASE("info rounds away what a box reaches too far, and minus zero") {
    const Place place;
    const std::string scene = place / "s.lua";
    const auto bounds = [&](const std::string& solid) {
        write_file(scene, "return { solids = { " + solid + " } }");
        const std::string out = run({"info", scene}).out;
        const std::size_t at = out.find(" in [");
        return out.substr(at + 4, out.find('\n', at) - at - 4);
    };
    CHECK(bounds("cube()") == "[0, 1] x [0, 1] x [0, 1]");
    CHECK(bounds("cube():translate(0, 0, -1)") == "[0, 1] x [0, 1] x [-1, 0]");
    CHECK(bounds("halfspace({0, 1, 0}, 0)") == "[-inf, inf] x [-inf, 0] x [-inf, inf]");
    CHECK(bounds("halfspace({0, 1, 0}, 1e-9)") == "[-inf, inf] x [-inf, 1e-09] x [-inf, inf]");
    CHECK(bounds("box({0, -0.015, 0}, {110, 0, 83.185})") == "[0, 110] x [-0.015, 0] x [0, 83.185]");
    CHECK(bounds("box({0, 1e-7, -3e-7}, {1e-6, 2e-6, 0})") == "[0, 1e-06] x [1e-07, 2e-06] x [-3e-07, 0]");
    CHECK(bounds("box({0, -1e12, 0}, {3e14, 123456, 7})") == "[0, 3e+14] x [-1e+12, 0] x [0, 0]");
    CHECK(bounds("ellipsoid{ center = {0, 2, 0}, radius = 2 }") == "[-2, 2] x [0, 4] x [-2, 2]");
    const auto j = nlohmann::json::parse(run({"info", "--json", scene}).out);
    CHECK(j["solids"][0]["bounds"]["lo"].dump() == "[-2.0,0.0,-2.0]");
}

TEST_CASE("no name and no text of a scene reaches the terminal as a control character") {
    const Place place;
    const std::string scene = place / "a\33[31m.lua", title = "\33]0;owned\7\302\233";
    write_file(scene,
               "print('\\27]0;printed\\7', 'a\\nb') local s = '\\27]0;owned\\7\\194\\155'\n"
               "return { solids = { rounded(param(s, 0.1), cube()):name(s) } }");
    const auto is_clean = [](const std::string& text) {
        return text.find_first_of("\33\7\177") == std::string::npos && text.find("\302\233") == std::string::npos;
    };
    const Outcome info = run({"info", scene});
    CHECK(info.code == 0);
    CHECK(is_clean(info.out));
    CHECK(is_clean(info.err));
    CHECK(info.err == "\\x1b]0;printed\\x07\ta\nb\n");
    CHECK(info.out.find("scene         ") == 0);
    CHECK(info.out.find("a\\x1b[31m.lua\n") != std::string::npos);
    CHECK(info.out.find("\\x1b]0;owned\\x07\\u{9b}: 6 half-spaces") != std::string::npos);
    CHECK(info.out.find("parameter     \\x1b]0;owned") != std::string::npos);
    const Outcome json = run({"info", "--json", scene});
    CHECK(is_clean(json.out));
    CHECK(nlohmann::json::parse(json.out)["solids"][0]["name"] == title);
    const Outcome mesh = run({"mesh", scene, "--stats", "-q"});
    CHECK(mesh.code == 0);
    CHECK(is_clean(mesh.out));
    write_file(scene, "error('\\27[2J')");
    const Outcome wrong = run({"info", scene});
    CHECK(wrong.code == 2);
    CHECK(is_clean(wrong.err));
    CHECK(wrong.err.find("a\\x1b[31m.lua:1: \\x1b[2J\n") != std::string::npos);
    CHECK(is_clean(run({"info", "\33[31m.lua"}).err));
    CHECK(is_clean(run({"\33[31m"}).err));
}

TEST_CASE("a scene is read once, so that it may come from a pipe") {
    const Place place;
    const auto shell = [](const std::string& command) {
        return WEXITSTATUS(std::system(("bash -c \"" + command + "\"").c_str()));
    };
    const std::string program = "'" DEBURR_PROGRAM "' ", output = " -q -o '" + place / "a.png" + "'";
    CHECK(shell("cat '" + place.scene + "' | " + program + "render /dev/stdin" + output) == 0);
    CHECK(Picture(place / "a.png").spec.width == 60);
    CHECK(shell(program + "render <(cat '" + place.scene + "')" + output + " -D r=0.2") == 0);
    CHECK(shell("mkfifo '" + place / "fifo" + "'; cat '" + place.scene + "' > '" + place / "fifo" + "' & " + program +
                "info '" + place / "fifo" + "' > '" + place / "out" + "'") == 0);
    CHECK(read_file(place / "out").find("60x40") != std::string::npos);
    CHECK(shell(program + "info /dev/stdin < '" + place.scene + "' > /dev/null") == 0);
    CHECK(shell(program + "info /dev/null 2> '" + place / "err" + "'") == 2);
    CHECK(read_file(place / "err").find("deburr: /dev/null: scene: expected the chunk to return") == 0);
}

TEST_CASE("a scene that prints without an end stops at a limit") {
    const Place place;
    write_file(place / "p.lua", "local s = ('a'):rep(2^10) while true do pcall(print, s) end");
    const Outcome o = run({"info", place / "p.lua"});
    CHECK(o.code == 2);
    CHECK(o.err.size() < (1 << 20) + 300);
    const std::string last = o.err.substr(o.err.rfind('\n', o.err.size() - 2) + 1);
    CHECK(last == "deburr: " + place / "p.lua" +
                      ":1: expected a scene that prints at most 1048576 bytes, got one that prints more\n");
}

TEST_CASE("a density that is too entangled to be evaluated is not supported, and soon told") {
    // Pairs of half-spaces in the worst of orders: the diagram doubles with each.
    const Place place;
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
