// `deburr help`: commands, topics, entries by name, and suggestions for unknown names.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "catch.hpp"
#include "raytracer/cli/scene_page.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("help prints commands and topics; of a command the same as its --help") {
    const Outcome all = run({"help"});
    CHECK(all.code == 0);
    CHECK(contains(all.out, "  render "));
    CHECK(contains(all.out, "  materials    matte plastic metal mirror glass pbr\n"));
    for (const char* command : {"render", "mesh", "compare", "info", "export-pov", "figures", "help"}) {
        CAPTURE(command);
        CHECK(run({"help", command}).out == run({command, "--help"}).out);
    }
}

TEST_CASE("help prints topics whole, by one or many, and entries by their names") {
    const std::string materials = run({"help", "materials"}).out;
    CHECK(contains(materials, "Materials\n=========\n"));
    CHECK(contains(materials, "glass{…}\n--------\n"));
    CHECK(run({"help", "Materials"}).out == materials);
    CHECK(contains(run({"help", "material"}).out, materials));  // `material` is also a method
    CHECK(contains(run({"help", "material"}).out, "x:material(m)\n"));
    CHECK(contains(run({"help", "scene"}).out, "camera\n------\n"));
    CHECK(contains(run({"help", "density"}).out, "halfspace(normal, d)\n"));

    const std::string rounded = run({"help", "rounded"}).out;
    CHECK(rounded.rfind("rounded(radius, density)\n------------------------\n", 0) == 0);
    CHECK(contains(rounded, "  radius        a number >= 0. The rounding radius; 0 is sharp.\n"));
    CHECK(contains(rounded, "\n    local die = rounded(0.1, cube())\n"));
    CHECK(run({"help", ":translate"}).out == run({"help", "translate"}).out);
    CHECK(run({"help", "|"}).out.rfind("a | b\n", 0) == 0);
    CHECK(run({"help", "rounded", "|"}).out == rounded + "\n" + run({"help", "|"}).out);
}

TEST_CASE("help tells what a field is of everything that has it") {
    const std::string roughness = run({"help", "roughness"}).out;
    for (const char* owner : {"plastic{…}\n", "metal{…}\n", "glass{…}\n"}) CHECK(contains(roughness, owner));
    CHECK_FALSE(contains(roughness, "matte"));
    CHECK_FALSE(contains(roughness, "ior"));
    CHECK(contains(roughness, "  roughness     a number from 0 to 1, or a texture; default: 0.2. Of the layer.\n"));
}

TEST_CASE("help has no marks of Markdown left, and lines of 80 columns outside of code") {
    for (const PagePart& part : parts_of_page(scene_page())) {
        const std::string text = plain_text(part);
        INFO(text);
        CHECK_FALSE(contains(text, "`"));
        CHECK_FALSE(contains(text, "**"));
        CHECK_FALSE(contains(text, "]("));
        CHECK_FALSE(contains(text, "!["));
        CHECK_FALSE(contains(text, "|---"));
        std::size_t start = 0;
        for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
            const std::string line = text.substr(start, end - start);
            const auto columns = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
            if (line.rfind("    ", 0) != 0) CHECK(columns <= 80);
        }
    }
}

TEST_CASE("an unknown name of help, an unknown command and an unknown option come with the nearest one") {
    struct Case {
        std::vector<std::string> words;
        const char* error;
    };
    const Case cases[] = {
        {{"help", "mattte"},
         "help: expected a command or a name of the scene language, got 'mattte', did you mean matte? (see deburr "
         "help)"},
        {{"help", "rendre"},
         "help: expected a command or a name of the scene language, got 'rendre', did you mean render? (see deburr "
         "help)"},
        {{"help", "xyzzy"}, "help: expected a command or a name of the scene language, got 'xyzzy' (see deburr help)"},
        {{"help", "matte", "roughnes"},
         "help: expected a command or a name of the scene language, got 'roughnes', did you mean roughness? (see "
         "deburr help)"},
        {{"a.lua", "-o", "a.png"}, "unknown command 'a.lua', did you mean render a.lua? (see deburr --help)"},
        {{"rendr", "a.lua"}, "unknown command 'rendr', did you mean render? (see deburr --help)"},
        {{"render", "a.lua", "--sise=3x3"}, "unknown option '--sise', did you mean --size? (see deburr render --help)"},
        {{"mesh", "a.lua", "--tolerence", "1"},
         "unknown option '--tolerence', did you mean --tolerance? (see deburr mesh --help)"},
        {{"--versoin"}, "unknown option '--versoin', did you mean --version? (see deburr --help)"},
        {{"render", "mesh"}, "render: expected an output file, -o FILE"},  // takes "mesh" as the scene's name
        {{"help", "--completion", "tcsh"}, "--completion: expected bash, zsh or fish, got 'tcsh'"},
        {{"help", "--markdown", "rendr"}, "--markdown: expected a command, got 'rendr'"},
    };
    for (const Case& c : cases) {
        const Outcome outcome = run(c.words);
        CHECK(outcome.code == 2);
        CHECK(outcome.out == "");
        CHECK(outcome.err == std::string("deburr: ") + c.error + "\n");
    }
}

TEST_CASE("an installed program's help reads no file") {
    const Folder folder;
    const std::string copy = folder / "deburr";
    std::filesystem::copy_file(DEBURR_PROGRAM, copy);
    CHECK(std::system(("cd / && '" + copy + "' help scene >'" + (folder / "out") + "'").c_str()) == 0);
    CHECK(read_file(folder / "out") == run({"help", "scene"}).out);
}
