// Every scene in scenes/ renders like its golden picture in tests/golden.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

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

    const OIIO::ImageBuf a(DEBURR_SOURCE_DIR "/tests/golden/" + picture + ".png"), b(got);
    REQUIRE(a.spec().width == 150);
    // Rounding differs between compilers and processors, so single pixels on silhouettes may differ.
    const auto difference = OIIO::ImageBufAlgo::compare(a, b, 3 / 255.f, 3 / 255.f);
    if (difference.nfail > 14) {  // 0.1 % of the pixels
        OIIO::ImageBufAlgo::absdiff(a, b).write(picture + "_difference.png");
        FAIL_CHECK(difference.nfail << " pixels differ; see " << picture << "_difference.png");
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
