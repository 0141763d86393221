// The figures command: what it refuses, and which figures it makes again.
#include <algorithm>
#include <filesystem>

#include "catch.hpp"
#include "figures/command_figures.hpp"
#include "figures/figure.hpp"
#include "raytracer/cli/command_line.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

int made = 0;

// Makes a figure of one scene and counts how often it is made.
void make(FigureContext& context) {
    ++made;
    context.picture(context.render(context.scene("csg_examples.lua"), {.width = 8, .height = 6}), "a cube");
    context.table({{"name", "value"}, {{"one", "1"}}});
    context.measured("It was measured.");
}

const RegisteredFigure registered{{.name = "beyond-test",
                                   .title = "A test",
                                   .claim = "It is made once.",
                                   .scenes = {"csg_examples.lua"},
                                   .make = make}};

// Runs the figures command in this process, where the figure above is registered.
int figures(std::vector<std::string> words) {
    words.insert(words.begin(), {"deburr", "figures", "-q"});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return run_program(int(argv.size()), argv.data(), {add_figures_command});
}

}  // namespace

TEST_CASE("figures refuses names and folders that are none") {
    const Folder folder;
    const Outcome name = run({"figures", "lobb-99", "-o", folder / "out"});
    CHECK(name.code == 2);
    CHECK(name.err ==
          "deburr: figures: expected the name of a figure or of a paper (see deburr figures --list), got 'lobb-99'\n");
    CHECK(run({"figures"}).err == "deburr: figures: expected a folder for the pictures, -o DIR\n");
    CHECK(run({"figures", "-o", folder / "out", "--scenes", folder / "none"}).code == 2);
    CHECK(folder.names().empty());
    write_file(folder / "file", "");
    CHECK(run({"figures", "lobb-12", "-o", folder / "file"}).code == 1);
}

TEST_CASE("figures --list names them, and what is named can be asked for") {
    const Outcome all = run({"figures", "--list"});
    CHECK(all.code == 0);
    CHECK(all.out.find("lobb-12 ") != std::string::npos);
    CHECK(all.out.find("beyond-test") == std::string::npos);
    CHECK(run({"figures", "lobb-12", "--list"}).out.find("lobb-12") == 0);
    CHECK(run({"figures", "lobb", "--list"}).out.find("triage") == std::string::npos);
}

TEST_CASE("Without gnuplot a figure that plots is refused in one line, and nothing is made") {
    std::string plotted;
    for (const Figure& figure : all_figures())
        if (figure.plots) plotted = figure.name;
    if (plotted.empty()) return;
    const Folder folder;
    const Outcome outcome = run({"figures", plotted, "-o", folder / "out"}, {"PATH=" + (folder / "")});
    CHECK(outcome.code == 3);
    CHECK(outcome.err == "deburr: plots need the program gnuplot, which is not here (Debian: gnuplot-nox)\n");
    CHECK(folder.names().empty());
}

TEST_CASE("A figure is made again when its scene or a file of it changes, and only then") {
    const Folder folder;
    const std::string scenes = folder / "scenes", out = folder / "out";
    fs::create_directory(scenes);
    write_file(scenes + "/csg_examples.lua", "return { solids = { rounded(0.1, cube()) } }");
    const auto again = [&](std::vector<std::string> more = {}) {
        const int before = made;
        std::vector<std::string> words{"beyond-test", "-o", out, "--scenes", scenes};
        words.insert(words.end(), more.begin(), more.end());
        REQUIRE(figures(words) == 0);
        return made - before;
    };
    CHECK(again() == 1);
    CHECK(again() == 0);
    CHECK(again({"--again"}) == 1);
    write_file(scenes + "/csg_examples.lua", "return { solids = { rounded(0.2, cube()) } }");
    CHECK(again() == 1);
    CHECK(again() == 0);
    fs::remove(out + "/beyond-test.png");
    CHECK(again() == 1);
    write_file(out + "/beyond-test.png", "not what was written");
    CHECK(again() == 1);
    CHECK(again({"--draft"}) == 1);
    CHECK(again() == 1);
    write_file(out + "/figures.json", "{ torn");
    CHECK(again() == 1);
    fs::remove(out + "/README.md");
    CHECK(again() == 0);

    const std::string page = read_file(out + "/README.md");
    for (const char* text :
         {"### A test", "beyond-test.png", "a cube", "**Claim.** It is made once.", "**Measured.** It was measured.",
          "| one | 1 |", "[scenes/csg_examples.lua](../scenes/csg_examples.lua)"})
        CHECK(page.find(text) != std::string::npos);
}

TEST_CASE("Figures stand in the order of papers and numbers") {
    std::vector<std::string> names;
    for (const Figure& figure : all_figures()) names.push_back(figure.name);
    const auto place = [&](const char* name) { return std::find(names.begin(), names.end(), name) - names.begin(); };
    CHECK(place("lobb-12") < place("beyond-test"));
    CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
    for (const Figure& figure : all_figures()) {
        CAPTURE(figure.name);
        CHECK(!figure.title.empty());
        CHECK(!figure.claim.empty());
        for (const std::string& scene : figure.scenes) CHECK(fs::exists(DEBURR_SOURCE_DIR "/scenes/" + scene));
    }
}

TEST_CASE("Every figure and table of the three papers is there") {
    std::vector<std::string> names;
    for (const Figure& figure : all_figures()) names.push_back(figure.name);
    for (const char* name :
         {"lobb-2",    "lobb-5",       "lobb-6",           "lobb-7",           "lobb-10",    "lobb-12",
          "lobb-13",   "lobb-14",      "lobb-15",          "lobb-table-1",     "triage-1",   "triage-3",
          "triage-4",  "triage-5",     "triage-6",         "triage-8",         "triage-13",  "triage-15",
          "triage-16", "triage-17",    "triage-18",        "triage-19",        "triage-20",  "triage-21",
          "triage-22", "triage-robot", "triage-table-6.2", "triage-table-6.3", "vyatkin-1",  "vyatkin-2",
          "vyatkin-3", "vyatkin-8",    "vyatkin-10",       "vyatkin-11",       "vyatkin-14", "vyatkin-16"}) {
        CAPTURE(name);
        CHECK(std::count(names.begin(), names.end(), name) == 1);
    }
}
