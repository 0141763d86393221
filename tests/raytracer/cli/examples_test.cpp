// The examples of docs/examples.md render without warnings and have closed meshes, fit for printing.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> examples() {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(DEBURR_SOURCE_DIR "/scenes/examples"))
        if (entry.path().extension() == ".lua") all.push_back(entry.path().string());
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace

TEST_CASE("every example is rendered without a word, and is on the page with its picture") {
    const std::string page = read_file(DEBURR_SOURCE_DIR "/docs/examples.md");
    for (const std::string& scene : examples()) {
        CAPTURE(scene);
        const Folder folder;
        const Outcome outcome = run({"render", scene, "--draft", "--size", "60x38", "-o", folder / "a.png"});
        CHECK(outcome.code == 0);
        CHECK(without_progress(outcome.err) == "");
        const std::string name = fs::path(scene).stem().string();
        CHECK(page.find("../images/examples/" + name + ".png") != std::string::npos);
        CHECK(page.find("../scenes/examples/" + name + ".lua") != std::string::npos);
    }
    CHECK(examples().size() == 10);
}

TEST_CASE("every example is a closed mesh that passes its check", "[slow]") {
    for (const std::string& scene : examples()) {
        CAPTURE(scene);
        const Folder folder;
        const Outcome outcome = run({"mesh", scene, "-q", "-o", folder / "a.stl", "--stats-json", folder / "s.json"});
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        const auto stats = nlohmann::json::parse(read_file(folder / "s.json"));
        CHECK(stats["mesh"]["closed"] == true);
        CHECK(stats["mesh"]["triangles"] > 100);
    }
}
