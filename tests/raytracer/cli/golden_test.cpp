// Every scene in scenes/ renders like its golden picture in tests/golden.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

// Writes the absolute difference of two pictures' bytes.
void write_difference(const std::string& path, const PictureFile& a, const PictureFile& b) {
    ImageRaster difference{a.width, a.height, {0, 0, a.width, a.height}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k)
        difference.channels.push_back(image_channel(std::string(1, "RGB"[k]), ChannelType::byte, [&, k](std::size_t i) {
            return std::abs(int(a.bytes[3 * i + k]) - int(b.bytes[3 * i + k]));
        }));
    write_raster(path, difference);
}

// Renders the scene at 150 × 95 with the arguments `parameters` and compares it with tests/golden/<picture>.png.
void check_picture(const fs::path& scene, const std::string& picture, const std::vector<std::string>& parameters) {
    CAPTURE(picture);
    const Folder folder;
    const std::string got = folder / (picture + ".png");
    std::vector<std::string> words = {"render", scene.string(), "--size", "150x95", "-o", got};
    words.insert(words.end(), parameters.begin(), parameters.end());
    // Golden pictures of scenes that do not set `spp` have one sample per pixel.
    const auto image = nlohmann::json::parse(run({"info", "--json", scene.string()}).out)["image"];
    if (image["spp"].is_null()) words.insert(words.end(), {"--spp", "1"});
    const Outcome outcome = run(words);
    const bool illegal = picture == "illegal_sum";  // this scene is illegal on purpose
    CHECK(outcome.err.find("brighter than white") == std::string::npos);
    CHECK((outcome.err.find("warning: " + scene.string()) != std::string::npos) == illegal);
    REQUIRE(outcome.code == 0);

    const PictureFile a = read_back(DEBURR_SOURCE_DIR "/tests/golden/" + picture + ".png"), b = read_back(got);
    for (const PictureFile& p : {a, b}) {
        REQUIRE((p.width == 150 && p.height == 95));
        REQUIRE(p.types == std::vector<std::string>(3, "uint8"));
    }
    // Rounding differs between compilers and processors, so single pixels on silhouettes may differ.
    int differ = 0;
    for (std::size_t i = 0; i < a.bytes.size(); i += 3) {
        int most = 0;
        for (std::size_t k = i; k < i + 3; ++k) most = std::max(most, std::abs(int(a.bytes[k]) - int(b.bytes[k])));
        differ += most > 3;
    }
    if (differ > 14) {  // 0.1 % of the pixels
        write_difference(picture + "_difference.png", a, b);
        FAIL_CHECK(differ << " pixels differ; see " << picture << "_difference.png");
    }
}

}  // namespace

TEST_CASE("every scene in scenes/ renders like its golden picture", "[slow]") {
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(DEBURR_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".lua") continue;
        check_picture(entry.path(), entry.path().stem().string(), {});
        ++scenes;
    }
    CHECK(scenes >= 3);
}

TEST_CASE("the staplers and the hole punch have round pins, bores and springs on request") {
    for (const std::string name : {"staplers", "hole_punch"})
        check_picture(fs::path(DEBURR_SOURCE_DIR "/scenes") / (name + ".lua"), name + "_round",
                      {"-D", "columns=round"});
}
