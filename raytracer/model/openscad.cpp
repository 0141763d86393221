#include "raytracer/model/openscad.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "raytracer/model/model_format.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/printable.hpp"
#include "raytracer/util/scene_error.hpp"
#include "raytracer/util/temporary_folder.hpp"

extern char** environ;

namespace deburr {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// The lines of the output that begin with one of OpenSCAD's words for problems.
std::vector<std::string> complaints(const std::string& said) {
    std::vector<std::string> found;
    std::istringstream lines(said);
    for (std::string line; std::getline(lines, line);)
        for (const char* word : {"ERROR", "WARNING", "Parser error", "Can't", "Current top level object is"})
            if (line.rfind(word, 0) == 0) {
                found.push_back(printable(line));
                break;
            }
    return found;
}

}  // namespace

std::string openscad_output(const std::string& path) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) refuse_model(path, "expected a model, got: No such file or directory");
    const TemporaryFolder folder;
    const std::string stl = (folder / "model.stl").string(), log = (folder / "log").string();
    // A name that begins with a dash would be taken for an option.
    const std::string input = path.rfind('-', 0) == 0 ? "./" + path : path;
    std::string words[] = {"openscad", "-o", stl, input};
    char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&files, 1, 2);
    pid_t child = 0;
    const int error = posix_spawnp(&child, "openscad", &files, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    if (error == ENOENT)
        throw UnsupportedError(one_line(
            fmt::format("{}: expected the program openscad, which reads it, found none; install openscad, or export an "
                        "STL there",
                        file_mark),
            path));
    if (error != 0) throw WorkError(std::string("openscad: ") + std::strerror(error));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const std::vector<std::string> said = complaints(text_of(log));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !fs::exists(stl, ignored)) {
        std::string all;
        for (const std::string& line : said) all += (all.empty() ? "" : "; ") + line;
        if (all.empty())
            all = WIFSIGNALED(status) ? fmt::format("stopped by signal {}", WTERMSIG(status)) : "no reason";
        refuse_model(path, "openscad: " + all);
    }
    for (const std::string& line : said) std::fprintf(stderr, "openscad: %s\n", line.c_str());
    return text_of(stl);
}

}  // namespace deburr
