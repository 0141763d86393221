// Every scene in scenes/ still looks as it did when somebody looked at it.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;

TEST_CASE("every scene in scenes/ renders like its golden picture", "[slow]") {
    int scenes = 0;
    for (const auto& entry : fs::directory_iterator(DEBURR_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".lua") continue;
        const std::string name = entry.path().stem().string();
        CAPTURE(name);
        const Folder folder;
        const std::string got = folder / (name + ".png");
        std::vector<std::string> words = {"render", entry.path().string(), "--size", "150x95", "-o", got};
        // What says nothing of samples was looked at with one.
        const auto image = nlohmann::json::parse(run({"info", "--json", entry.path().string()}).out)["image"];
        if (image["spp"].is_null()) words.insert(words.end(), {"--spp", "1"});
        const Outcome outcome = run(words);
        const bool illegal = name == "illegal_sum";  // on purpose
        CHECK(outcome.err.find("brighter than white") == std::string::npos);
        CHECK((outcome.err.find("warning: " + entry.path().string()) != std::string::npos) == illegal);
        REQUIRE(outcome.code == 0);

        const OIIO::ImageBuf a(DEBURR_SOURCE_DIR "/tests/golden/" + name + ".png"), b(got);
        REQUIRE(a.spec().width == 150);
        // Other compilers and processors round differently: single pixels on silhouettes may change.
        const auto difference = OIIO::ImageBufAlgo::compare(a, b, 3 / 255.f, 3 / 255.f);
        if (difference.nfail > 14) {  // 0.1 %
            OIIO::ImageBufAlgo::absdiff(a, b).write(name + "_difference.png");
            FAIL_CHECK(difference.nfail << " pixels differ; see " << name << "_difference.png");
        }
        ++scenes;
    }
    CHECK(scenes >= 3);
}
