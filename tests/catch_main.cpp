// Main program of every test binary, for Catch2 2 and 3. It adds these options to Catch2's own:
//
//   test_bounds [OPTION | PATTERN …]   Catch2's own call; it fails if a run matches no case
//   test_bounds --case NAME            runs the one case of exactly this name; any other number of cases is a failure
//   test_bounds --share K N PATTERN    runs every N-th of the cases that match, from the K-th on, in one process: where
//                                      a process takes a second to begin, as with sanitizers
//   test_bounds --count                prints the number of cases that are compiled in
//   test_bounds --ctest FILE           writes CTest's list of the cases, with their labels
//
// Catch2's own list for CTest is made by a CMake script that cuts names at a semicolon. Catch2 2 then finds no case of
// such a name and reports success. This program asks the registry instead and counts the cases that ran.
//
// Labels: `program` where the case's file includes raytracer/program.hpp, which runs the program as a user would;
// `unit` elsewhere; and the case's tags [slow] and [threads], which tests/CMakeLists.txt explains.
#ifdef DEBURR_CATCH_2
#define CATCH_CONFIG_RUNNER
#endif
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "catch.hpp"

namespace {

// Names of the cases that this process has started.
std::vector<std::string>& begun() {
    static std::vector<std::string> names;
    return names;
}

#ifdef DEBURR_CATCH_2
using ListenerBase = Catch::TestEventListenerBase;
#else
using ListenerBase = Catch::EventListenerBase;
#endif

struct CountCases : ListenerBase {
    using ListenerBase::ListenerBase;
    void testCaseStarting(const Catch::TestCaseInfo& info) override { begun().push_back(info.name); }
};
CATCH_REGISTER_LISTENER(CountCases)

const auto& compiled_in() { return Catch::getRegistryHub().getTestCaseRegistry().getAllTests(); }

// Catch2 pattern that matches exactly this name; characters that have a meaning in patterns are escaped.
std::string pattern_of(const std::string& name) {
    std::string pattern;
    for (const char c : name) {
        if (std::string("\\,[]\"").find(c) != std::string::npos) pattern += '\\';
        pattern += c;
    }
    return pattern;
}

// `text` as a CMake bracket argument, which CMake takes literally.
std::string bracket_argument(const std::string& text) {
    std::string marks = "=";
    while (text.find("]" + marks + "]") != std::string::npos) marks += "=";
    return "[" + marks + "[" + text + "]" + marks + "]";
}

// True if the source file of a test includes raytracer/program.hpp. `path` is __FILE__ as the compiler was given it,
// which may start at another folder.
bool runs_program(const std::string& path) {
    const std::string mark = "/tests/";
    std::ifstream file(DEBURR_TESTS_DIR "/" + path.substr(path.rfind(mark) + mark.size()));
    if (path.rfind(mark) == std::string::npos || !file) throw std::runtime_error("cannot read the test " + path);
    for (std::string line; std::getline(file, line);)
        if (line == "#include \"raytracer/program.hpp\"") return true;
    return false;
}

void write_ctest(const std::string& path, const std::string& program, const std::string& folder) {
    std::map<std::string, bool> runs;  // by file
    std::ofstream file(path);
    for (const auto& test : compiled_in()) {
        const auto& info = test.getTestCaseInfo();
        const std::string source = info.lineInfo.file;
        if (!runs.count(source)) runs[source] = runs_program(source);
        const bool slow = info.tagsAsString().find("[slow]") != std::string::npos;
        const std::string name = bracket_argument(folder + ": " + info.name);
        file << "add_test(" << name << " " << bracket_argument(program) << " --case " << bracket_argument(info.name)
             << ")\nset_tests_properties(" << name << " PROPERTIES LABELS \"" << (runs[source] ? "program" : "unit")
             << (slow ? ";slow\" COST 100)\n" : "\")\n");  // CTest starts cases of high cost first
    }
    file.close();
    if (!file) throw std::runtime_error("cannot write " + path);
}

// Runs every n-th of the cases that the pattern matches, from index k on.
int run_share(Catch::Session& session, std::size_t k, std::size_t n, const std::string& pattern) {
    auto config = session.configData();
    config.testsOrTags = {pattern};
    config.showDurations = Catch::ShowDurations::Always;
    session.useConfigData(config);
    const auto all = Catch::getAllTestCasesSorted(session.config());
    const auto matching = Catch::filterTests(all, session.config().testSpec(), session.config());
    std::string share;
    for (std::size_t i = k; i < matching.size(); i += n)
        share += (share.empty() ? "" : ",") + pattern_of(matching[i].getTestCaseInfo().name);
    if (share.empty()) throw std::runtime_error("expected a case to run, none matched '" + pattern + "'");
    config.testsOrTags = {share};
    session.useConfigData(config);
    if (const int failed = session.run()) return failed;
    const std::size_t expected = (matching.size() - k - 1) / n + 1;
    if (begun().size() == expected) return 0;
    std::fprintf(stderr, "expected to run %zu cases of '%s', ran %zu\n", expected, pattern.c_str(), begun().size());
    return 1;
}

int run(int argc, char** argv) {
    const std::string option = argc > 1 ? argv[1] : "";
    if (option == "--count") {
        std::printf("%zu\n", compiled_in().size());
        return 0;
    }
    if (option == "--ctest" && argc == 5) {
        write_ctest(argv[2], argv[3], argv[4]);
        return 0;
    }
    Catch::Session session;
    if (option == "--case" && argc == 3) {
        session.configData().testsOrTags = {pattern_of(argv[2])};
        const int failed = session.run();
        if (failed) return failed;
        if (begun().size() == 1 && begun()[0] == argv[2]) return 0;
        std::fprintf(stderr, "expected to run the one case '%s', ran %zu\n", argv[2], begun().size());
        return 1;
    }
    if (option == "--share" && argc == 5) return run_share(session, std::stoul(argv[2]), std::stoul(argv[3]), argv[4]);
    if (const int failed = session.applyCommandLine(argc, argv)) return failed;
    const auto& config = session.configData();
    const bool only_says = config.showHelp || config.libIdentify || config.listTests || config.listTags ||
#ifdef DEBURR_CATCH_2
                           config.listTestNamesOnly ||
#else
                           config.listListeners ||
#endif
                           config.listReporters;
    const int failed = session.run();
    if (failed || only_says || !begun().empty()) return failed;
    std::fprintf(stderr, "expected a case to run, none matched\n");
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}
