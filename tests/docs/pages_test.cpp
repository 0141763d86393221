// Links, names of files and citations on the project's pages lead to something that exists.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "catch.hpp"
#include "docs/page.hpp"

using namespace deburr::test;
namespace fs = std::filesystem;

namespace {

const fs::path root = DEBURR_SOURCE_DIR;

std::vector<std::string> pages() {
    std::vector<std::string> all = {"README.md", "CONTRIBUTING.md", "CHANGELOG.md"};
    for (const auto& entry : fs::directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") all.push_back("docs/" + entry.path().filename().string());
    return all;
}

// The anchors that GitHub gives to a page's headings: lower-case words joined by dashes, without punctuation; the
// second heading of a name gets the suffix -1.
std::set<std::string> anchors_of(const std::string& page) {
    std::map<std::string, int> count;
    std::set<std::string> anchors;
    std::istringstream lines(page);
    bool code = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("```", 0) == 0) code = !code;
        if (code || line.empty() || line[0] != '#') continue;
        std::string anchor;
        for (const char c : line.substr(line.find(' ') + 1)) {
            const auto u = static_cast<unsigned char>(c);
            if (std::isalnum(u) || c == '-' || c == '_' || u >= 0x80) anchor += char(std::tolower(u));
            if (c == ' ') anchor += '-';
        }
        const int earlier = count[anchor]++;
        anchors.insert(earlier ? anchor + "-" + std::to_string(earlier) : anchor);
    }
    return anchors;
}

}  // namespace

TEST_CASE("every link and picture of the pages leads to a file and a heading of the project") {
    int links = 0;
    const std::regex link(R"(\]\(([^)\s]+)\)|<img src="([^"]+)\")");
    for (const std::string& name : pages()) {
        const std::string page = project_file(name);
        for (std::sregex_iterator at(page.begin(), page.end(), link), end; at != end; ++at) {
            const std::string target = (*at)[1].matched ? (*at)[1] : (*at)[2];
            if (target.rfind("http", 0) == 0) continue;
            INFO(name << ": " << target);
            const std::size_t mark = std::min(target.find('#'), target.size());
            const std::string path = target.substr(0, mark), anchor = target.substr(std::min(mark + 1, target.size()));
            const fs::path file = path.empty() ? fs::path(name) : fs::path(name).parent_path() / path;
            CHECK(fs::exists(root / file));
            if (!anchor.empty()) CHECK(anchors_of(project_file(file.string())).count(anchor) == 1);
            ++links;
        }
    }
    CHECK(links > 60);
}

TEST_CASE("every file and folder of the project that a page names in quotes is there") {
    int files = 0;
    const std::regex quoted_path("`((?:bounds|polygonizer|raytracer|figures|bench|tests|scenes|docs|images)/[^`*]*)`");
    for (const std::string& name : pages()) {
        const std::string page = project_file(name);
        for (std::sregex_iterator at(page.begin(), page.end(), quoted_path), end; at != end; ++at) {
            const std::string path = (*at)[1];
            INFO(name << ": " << path);
            CHECK(
                (fs::exists(root / path) || fs::exists(root / (path + ".hpp")) || fs::exists(root / (path + ".cpp"))));
            ++files;
        }
    }
    CHECK(files > 90);
}

TEST_CASE("what the code cites of docs/design.md is a heading of it") {
    std::set<std::string> headings;
    std::istringstream lines(project_file("docs/design.md"));
    for (std::string line; std::getline(lines, line);)
        if (line.rfind("## ", 0) == 0) headings.insert(line.substr(3));
    int citations = 0;
    const std::regex citation(R"(\[docs/design\.md, ([^\]]+)\])"), next_comment_line(R"(\n *///? *)");
    for (const char* top : {"bounds", "polygonizer", "raytracer", "figures"})
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            if (!entry.is_regular_file()) continue;
            const std::string file = fs::relative(entry.path(), root).string();
            const std::string text = std::regex_replace(project_file(file), next_comment_line, " ");
            for (std::sregex_iterator at(text.begin(), text.end(), citation), end; at != end; ++at) {
                INFO(file << ": " << (*at)[1]);
                CHECK(headings.count((*at)[1]) == 1);
                ++citations;
            }
        }
    CHECK(citations >= 2);
}

TEST_CASE("the README is a front page of at most 120 lines, and its scene is docs/knob.lua") {
    const std::string readme = project_file("README.md");
    CHECK(std::count(readme.begin(), readme.end(), '\n') <= 120);
    REQUIRE(lua_blocks(readme).size() == 1);
    CHECK(lua_blocks(readme)[0] == project_file("docs/knob.lua"));
    CHECK(lua_blocks(project_file("docs/scenes.md"))[0] == "-- knob.lua\n" + project_file("docs/knob.lua"));
}

TEST_CASE("every small picture of docs/scenes.md is one that docs/pictures.lua makes") {
    const std::string page = project_file("docs/scenes.md"), scene = project_file("docs/pictures.lua");
    const std::regex picture("images/docs/([a-z_]+)\\.png");
    int pictures = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), picture), end; at != end; ++at, ++pictures) {
        INFO((*at)[1]);
        CHECK(scene.find((*at)[1].str() + " = ") != std::string::npos);
    }
    CHECK(pictures == 16);
}
