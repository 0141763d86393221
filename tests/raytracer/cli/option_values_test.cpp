// Values of command-line options: what is accepted, and the errors for everything else.
#include "raytracer/cli/option_values.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "catch.hpp"
#include "raytracer/program.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

template <class Function>
std::string usage_error(Function function) {
    try {
        function();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "none";
}

}  // namespace

TEST_CASE("sizes within the limits are read, others are named") {
    CHECK(parse_size("--size", "1x1000000") == Size{1, 1000000});
    CHECK(parse_size("--size", "30000x30000") == Size{30000, 30000});
    for (const char* text : {"0x1", "1x0", "-1x5", "5x-1", "1000001x1", "5", "x", "5x", "x5", "5x5x5", "5X5", " 5x5",
                             "5x5 ", "5.0x5", "+5x5", "0x10x5", "", "99999999999999999999x1"}) {
        CAPTURE(text);
        CHECK(usage_error([&] { parse_size("--size", text); }) ==
              "--size: expected WxH, each from 1 to 1000000, got '" + std::string(text) + "'");
    }
}

TEST_CASE("limits of pixels are on what is rendered at once") {
    check_pixels("--crop", {900000, 900000, 16384, 16384});
    check_pixels("--crop", {0, 0, 65536, 4096});
    CHECK(
        usage_error([] {
            check_pixels("--size", {0, 0, 16384, 16385});
        }) ==
        "--size: expected at most 268435456 pixels and 65536 a side at once (--crop renders parts), got '16384x16385'");
    CHECK(usage_error([] { check_pixels("--size", {0, 0, 65537, 1}); }) != "none");
}

TEST_CASE("crops are X11 geometry strings within the picture") {
    CHECK(parse_crop("--crop", "10x20+3+4") == Window{3, 4, 10, 20});
    for (const char* text : {"10x20", "10x20+3", "10x20+3-4", "10x20-3+4", "0x20+3+4", "10x20+3+4+5", "10x20++4",
                             "10x20+3+99999999999", "+3+4", ""}) {
        CAPTURE(text);
        CHECK(usage_error([&] { parse_crop("--crop", text); }) ==
              "--crop: expected WxH+X+Y, for example 100x50+20+10, got '" + std::string(text) + "'");
    }
    check_crop("--crop", {0, 0, 60, 40}, {60, 40});
    check_crop("--crop", {59, 39, 1, 1}, {60, 40});
    CHECK(usage_error([] {
              check_crop("--crop", {59, 0, 2, 1}, {60, 40});
          }) == "--crop: expected a window within the picture of 60x40, got '2x1+59+0'");
    CHECK(usage_error([] { check_crop("--crop", {0, 40, 1, 1}, {60, 40}); }) != "none");
    CHECK(usage_error([] { check_crop("--crop", {65536, 65536, 65536, 65536}, {60, 40}); }) != "none");
}

TEST_CASE("layers by name") {
    CHECK(parse_layers("--aov", "P,N,Z,albedo,normal,id,cost,crypto") == all_layers());
    CHECK(usage_error([] { parse_layers("--aov", "P,Q"); }) ==
          "--aov: expected some of P, N, Z, albedo, normal, id, cost, crypto, got 'Q'");
    for (const char* text : {"", ",", "P,", ",P", "p", "P N", "P, N"}) {
        CAPTURE(text);
        CHECK(usage_error([&] { parse_layers("--aov", text); }) != "none");
    }
}

TEST_CASE("whole numbers and seeds") {
    CHECK(parse_whole("--spp", "1", 1, 10) == 1);
    CHECK(parse_whole("--spp", "10", 1, 10) == 10);
    CHECK(parse_seed("--seed", "18446744073709551615") == 18446744073709551615u);
    for (const char* text : {"0", "11", "-1", "1.5", "", "1e1", " 1", "1 ", "99999999999999999999"}) {
        CAPTURE(text);
        CHECK(usage_error([&] { parse_whole("--spp", text, 1, 10); }) ==
              "--spp: expected a whole number from 1 to 10, got '" + std::string(text) + "'");
    }
    CHECK(usage_error([] { parse_seed("--seed", "18446744073709551616"); }) != "none");
    CHECK(usage_error([] { parse_seed("--seed", "-1"); }) != "none");
}

TEST_CASE("parameters are name=value, each once") {
    std::map<std::string, std::string> defines;
    parse_define("-D", "r=0.2", defines);
    parse_define("-D", "_a1=b=c", defines);
    CHECK(defines == std::map<std::string, std::string>{{"r", "0.2"}, {"_a1", "b=c"}});
    for (const char* text : {"r", "=1", "1r=2", "a b=2", "r=", ""}) {
        CAPTURE(text);
        CHECK(usage_error([&] { parse_define("-D", text, defines); }) ==
              "-D: expected name=value, got '" + std::string(text) + "'");
    }
    CHECK(usage_error([&] { parse_define("-D", "r=3", defines); }) == "-D: expected 'r' once, got 'r=3'");
}

TEST_CASE("criteria") {
    CHECK(parse_criterion("--criterion", "exact") == Criterion::exact);
    CHECK(parse_criterion("--criterion", "lobb") == Criterion::lobb);
    CHECK(usage_error([] { parse_criterion("--criterion", "x"); }) == "--criterion: expected exact or lobb, got 'x'");
}

TEST_CASE("outputs: a known extension, in small or capital letters, and each file once") {
    check_image_names("-o", {"a.exr", "a.png", "A.PNG", "dir.d/a.jpeg", "a.b.JPG"});
    for (const char* name : {"", "a", "a.foo", ".exr", "exr", "a.exr/b", "a.exr~", "a.tiff", "a.lua"}) {
        CAPTURE(name);
        CHECK(usage_error([&] {
                  check_image_names("-o", {name});
              }).rfind("-o: expected a file name that ends in .exr", 0) == 0);
    }
    CHECK(usage_error([] {
              check_image_names("-o", {"a.exr", "./a.exr"});
          }) == "outputs: expected different files, got './a.exr'");
    CHECK(usage_error([] { check_distinct({"x/../b", "b"}); }) != "none");
}

TEST_CASE("no output is an input or another output, by whatever name") {
    const Folder folder;
    namespace fs = std::filesystem;
    write_file(folder / "a.lua", "");
    fs::create_symlink("a.lua", folder / "soft.png");
    fs::create_hard_link(folder / "a.lua", folder / "hard.png");
    fs::create_symlink("later.png", folder / "dangling.png");
    fs::create_directory(folder / "sub");
    const std::string input = folder / "a.lua";
    const auto clash = [&](const std::string& output, const std::string& second = "") {
        return usage_error([&] { check_outputs({output}, {second}, {"", input}); });
    };
    CHECK(clash(folder / "b.png") == "none");
    CHECK(clash(folder / "b.png", folder / "c.json") == "none");
    CHECK(clash(input) == "outputs: expected other files than the input '" + input + "', got '" + input + "'");
    for (const char* name : {"soft.png", "hard.png", "sub/../a.lua", "./a.lua"}) {
        CAPTURE(name);
        CHECK(clash(folder / name) != "none");
        CHECK(clash(folder / "b.png", folder / name) != "none");
    }
    const int open_file = open(input.c_str(), O_RDONLY);
    CHECK(clash("/proc/self/fd/" + std::to_string(open_file)) != "none");
    close(open_file);
    CHECK(clash(folder / "later.png", folder / "dangling.png") != "none");
    CHECK(clash(folder / "b.png", folder / "sub/../b.png") != "none");
    CHECK(usage_error([] { check_outputs({"/dev/stdout"}, {}, {"/dev/stdin"}); }) == "none");
}
