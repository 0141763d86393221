#include "figures/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "figures/plot.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/temporary_folder.hpp"

extern char** environ;

namespace deburr {
namespace {

namespace fs = std::filesystem;

constexpr const char* absent = "plots need the program gnuplot, which is not here (Debian: gnuplot-nox)";

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream out;
    out << file.rdbuf();
    return out.str();
}

// Runs the program with its output in `log`; returns its exit code.
int call(const std::vector<std::string>& words, const std::string& log) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&files, 1, 2);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, argv[0], &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error == ENOENT) throw UnsupportedError(absent);
    if (error) throw WorkError(fmt::format("cannot start gnuplot: {}", std::strerror(error)));
    int status = 0;
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR) throw WorkError(fmt::format("cannot wait for gnuplot: {}", std::strerror(errno)));
    // The exit code 127 means that the program could not be started.
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw UnsupportedError(absent);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The first lines of a text, as one line.
std::string first_words(const std::string& text) {
    std::istringstream in(text);
    std::string out;
    for (std::string line; std::getline(in, line) && out.size() < 200;) {
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string::npos) continue;
        if (!out.empty()) out += ' ';
        out.append(line, start);
    }
    return out;
}

}  // namespace

std::string run_gnuplot(const std::string& terminal, const std::string& script) {
    const TemporaryFolder folder;
    const std::string picture = folder / "picture", log = folder / "log", file = folder / "script";
    std::string quoted;  // escaped for gnuplot's single quotes
    for (const char c : picture) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    std::ofstream(file, std::ios::binary) << terminal << "set output '" << quoted << "'\n"
                                          << script << "unset output\n";
    // -d ignores the user's own settings, so that pictures are the same everywhere.
    const int code = call({"gnuplot", "-d", file}, log);
    const std::string bytes = contents(picture);
    if (code != 0 || bytes.empty())
        throw WorkError(fmt::format("gnuplot failed with exit code {}: {}", code, first_words(contents(log))));
    return bytes;
}

void require_gnuplot() {
    const TemporaryFolder folder;
    call({"gnuplot", "--version"}, folder / "log");
}

}  // namespace deburr
