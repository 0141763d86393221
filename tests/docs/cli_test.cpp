// docs/cli.md, the manual page and the shell completions agree with the command line's options.
#include <array>
#include <cstdio>
#include <regex>
#include <set>
#include <sstream>

#include "catch.hpp"
#include "docs/page.hpp"
#include "raytracer/program.hpp"

using namespace deburr::test;

namespace {

// Names of all commands, from the error "expected a command: render, mesh, … (see deburr --help)".
std::set<std::string> commands() {
    const std::string error = run({}).err, start = "expected a command: ";
    const std::size_t from = error.find(start) + start.size();
    std::istringstream list(error.substr(from, error.find(" (see") - from));
    std::set<std::string> names;
    for (std::string name; std::getline(list >> std::ws, name, ',');) names.insert(name);
    return names;
}

// Every spelling of a command's options, from its own help.
std::set<std::string> options_of(const std::string& command) {
    const std::string help = run({command, "--help"}).out;
    std::set<std::string> names;
    const std::regex line("\n  (-[^ ]+)");
    for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
        std::istringstream list((*at)[1]);
        for (std::string name; std::getline(list, name, ',');) names.insert(name);
    }
    return names;
}

std::string output_of(const std::string& shell_command) {
    std::FILE* pipe = popen(shell_command.c_str(), "r");
    REQUIRE(pipe);
    std::string text;
    std::array<char, 4096> buffer;
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), size);
    CHECK(pclose(pipe) == 0);
    return text;
}

}  // namespace

TEST_CASE("docs/cli.md has every command with its options as the program has them; ./run docs renews them") {
    const std::string page = project_file("docs/cli.md");
    const std::regex start("<!-- options: ([a-z-]+) -->\n");
    std::set<std::string> on_page;
    for (std::sregex_iterator at(page.begin(), page.end(), start), end; at != end; ++at) {
        const std::string command = (*at)[1];
        const std::size_t from = std::size_t(at->position() + at->length());
        INFO(command);
        CHECK(page.substr(from, page.find("<!-- end of options -->", from) - from) ==
              run({"help", "--markdown", command}).out);
        on_page.insert(command);
    }
    CHECK(on_page == commands());
    CHECK(on_page.count("render") == 1);
}

TEST_CASE("the manual page, the completions and docs/cli.md name every option that a command's help names") {
    const std::string manual = run({"help", "--man"}).out;
    const std::string bash = run({"help", "--completion", "bash"}).out;
    const std::string zsh = run({"help", "--completion", "zsh"}).out;
    const std::string fish = run({"help", "--completion", "fish"}).out;
    int options = 0;
    for (const std::string& command : commands()) {
        const std::string table = run({"help", "--markdown", command}).out;
        for (const std::string& name : options_of(command)) {
            INFO(command << " " << name);
            CHECK(std::regex_search(table, std::regex("[` ]" + name + "[`, ]")));
            CHECK(manual.find("\\fB" + std::regex_replace(name, std::regex("-"), "\\-")) != std::string::npos);
            CHECK(std::regex_search(bash, std::regex("[\" ]" + name + "[\" ]")));
            CHECK(zsh.find("'*" + name + "[") != std::string::npos);
            const bool is_long = name.rfind("--", 0) == 0;
            CHECK(fish.find((is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1) + " ") != std::string::npos);
            ++options;
        }
    }
    CHECK(options > 60);
}

TEST_CASE("bash completes commands, options and their values") {
    const Folder folder;
    const std::string script = folder / "deburr.bash";
    write_file(script, run({"help", "--completion", "bash"}).out);
    const auto completed = [&](const std::string& words, int at) {
        return output_of("bash -c '. \"" + script + "\"; COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                         "; _deburr; echo \"${COMPREPLY[*]}\"'");
    };
    CHECK(completed("deburr me", 1) == "mesh merge\n");
    CHECK(completed("deburr render --cr", 2) == "--crop --criterion\n");
    CHECK(completed("deburr render a.lua --accel e", 4) == "embree\n");
    CHECK(completed("deburr info --cr", 2) == "\n");
    CHECK(completed("deburr render a", 2) == "\n");  // files are the shell's to complete
}
