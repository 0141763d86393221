// `deburr compare`, as a user calls it, of two pictures.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

TEST_CASE("compare says how two files differ, and its limits are exit codes") {
    const Folder folder;
    write_file(folder / "s.lua", cube_scene());
    for (const char* r : {"r=0.05", "r=0.2"})
        REQUIRE(run({"render", folder / "s.lua", "-q", "-D", r, "--aov", "P,N,id", "-o",
                     folder / (std::string(r) + ".exr")})
                    .code == 0);
    const std::string a = folder / "r=0.05.exr", b = folder / "r=0.2.exr";
    CHECK(run({"compare", a, a, "--max-rmse", "1e-9"}).code == 0);
    CHECK(run({"compare", a, a, "--max-missed", "0", "--max-distance", "0", "--max-rmse", "0"}).code == 0);
    CHECK(run({"compare", a, b, "--max-rmse", "1e-9"}).code == 1);
    CHECK(run({"compare", a, a, "--max-rmse", "-1"}).code == 2);
    CHECK(run({"compare", a, folder / "none.exr"}).code == 2);

    // Without a limit in the call, the report does not claim that limits are met.
    REQUIRE(run({"compare", a, b, "--json", folder / "j"}).code == 0);
    CHECK(nlohmann::json::parse(read_file(folder / "j"))["within_limits"].is_null());
    CHECK(run({"compare", a, b}).out.find("within_limits       no limit was given\n") != std::string::npos);
    REQUIRE(run({"compare", a, b, "--max-rmse", "9", "--json", folder / "j"}).code == 0);
    CHECK(nlohmann::json::parse(read_file(folder / "j"))["within_limits"] == true);
}

TEST_CASE("what a picture's header claims is believed as far as the file's size allows", "[slow]") {
    const Folder folder;
    const auto big_endian = [](std::uint32_t n) {
        return std::string{char(n >> 24), char(n >> 16), char(n >> 8), char(n)};
    };
    // A PNG whose header claims 20,000 × 20,000 pixels, with a valid checksum [PNG §11.2.1], but whose data are
    // missing.
    std::string head = "IHDR" + big_endian(20000) + big_endian(20000) + std::string("\x08\x06\x00\x00\x00", 5);
    std::uint32_t crc = 0xffffffffu;
    for (const char c : head) {
        crc ^= static_cast<unsigned char>(c);
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    write_file(folder / "a.png", "\x89PNG\r\n\x1a\n" + big_endian(13) + head + big_endian(~crc) + big_endian(5000) +
                                     "IDAT" + std::string(5000, 'x'));
    const Outcome o = run({"compare", folder / "a.png", folder / "a.png"});
    CAPTURE(o.err);
    CHECK(o.code == 2);
    CHECK(o.err.find("expected a file that holds the 20000x20000 pixels of its header, got 5041 bytes\n") !=
          std::string::npos);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    // A black picture is a small file in every format and must be read.
    write_file(folder / "black.lua",
               "return { image = { width = 700, height = 600 }, background = {0, 0, 0}, "
               "solids = { rounded(0.1, cube()):translate(0, -1e5, 0) } }");
    std::vector<std::string> words{"render", folder / "black.lua", "-q", "--spp", "1"};
    const std::vector<std::string> names{"b.exr", "b.png", "b.webp", "b.jpg"};
    for (const std::string& name : names) words.insert(words.end(), {"-o", folder / name});
    REQUIRE(run(words).code == 0);
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK(run({"compare", "-q", "--max-rmse", "0.01", folder / name, folder / name}).code == 0);
    }
}

TEST_CASE("compare tells solids of two files apart where both say which they saw") {
    const Folder folder;
    const std::string left = "rounded(0.1, cube()):translate(-2, 0, 0)",
                      right = "rounded(0.1, cube()):translate(1, 0, 0)";
    write_file(folder / "a.lua", "return { solids = {" + left + ", " + right + "} }");
    write_file(folder / "b.lua", "return { solids = {" + right + ", " + left + "} }");
    for (const std::string name : {"a", "b"})
        REQUIRE(run({"render", folder / (name + ".lua"), "-q", "--size", "60x40", "--spp", "1", "--aov", "id", "-o",
                     folder / (name + ".exr"), "-o", folder / (name + ".png")})
                    .code == 0);
    const auto compared = [&](const char* a, const char* b) {
        run({"compare", folder / a, folder / b, "-q", "--json", folder / "d.json"});
        const auto d = nlohmann::json::parse(read_file(folder / "d.json"));
        return std::pair{d["other_solid"].get<int>(), d["pixels_on_object"].get<int>()};
    };
    const auto [other, all] = compared("a.exr", "b.exr");
    CHECK(all > 100);
    CHECK(other == all);
    CHECK(compared("a.exr", "a.exr").first == 0);
    CHECK(compared("a.exr", "b.png").first == 0);
}
