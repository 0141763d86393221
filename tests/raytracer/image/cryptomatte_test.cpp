// Cryptomatte layers: hashes of names, the manifest, and shares of pixels.
#include "raytracer/image/cryptomatte.hpp"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

TEST_CASE("Names have the hashes of MurmurHash3_x86_32") {
    CHECK(murmur3("") == 0);
    CHECK(murmur3("test") == 0xba6bd213);
    CHECK(murmur3("Hello, world!") == 0xc0363e43);
    CHECK(murmur3("The quick brown fox jumps over the lazy dog") == 0x2e4ff723);
    for (int i = 0; i < 5000; ++i) CHECK(std::isnormal(cryptomatte_number(std::to_string(i))));
}

TEST_CASE("Cryptomatte is read back: names by the manifest, and shares of each pixel") {
    const Folder folder;
    // One box covers exactly the left half of the picture, another behind it the right half.
    write_file(folder / "s.lua",
               "return { image = { width = 8, height = 4 }, camera = { eye = {0, 0, 9}, projection = 'orthographic' },"
               " lights = {}, ambient = 1, background = 0.5, solids = { box({-90, -90, -1}, {0, 90, 0}):name('left'),"
               " box({0, -90, -9}, {90, 90, -8}) } }");
    const Outcome o = run({"render", folder / "s.lua", "-q", "--spp", "64", "--aov", "crypto", "-o", folder / "a.exr"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    const PictureFile picture = read_back(folder / "a.exr");
    std::string manifest;
    for (const auto& [name, value] : picture.attributes)
        if (name.find("cryptomatte/") == 0 && name.find("/manifest") != std::string::npos)
            manifest = std::get<std::string>(value);
    const auto names = nlohmann::json::parse(manifest);
    const auto hash = [&](const char* name) {
        return std::bit_cast<float>(std::uint32_t(std::stoul(names[name].get<std::string>(), nullptr, 16)));
    };
    const auto share = [&](int x, const char* name) {
        double sum = 0;
        for (const char* pair : {"00.RG", "00.BA", "01.RG", "01.BA", "02.RG", "02.BA"}) {
            const auto at = [&](char letter) {
                return picture.at(x, 1, "CryptoObject" + std::string(pair, 3) + letter);
            };
            if (at(pair[3]) == hash(name)) sum += at(pair[4]);
        }
        return sum;
    };
    CHECK(share(0, "left") == 1);
    CHECK(share(3, "left") > 0.5);  // the pixel filter reaches across the border
    CHECK(share(3, "left") < 1);
    CHECK(share(3, "left") + share(3, "solid 2") == Approx(1).margin(1e-6));
    CHECK(share(7, "left") == 0);
    CHECK(share(4, "solid 2") == Approx(share(3, "left")).margin(0.05));
}
