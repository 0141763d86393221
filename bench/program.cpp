#include "bench/program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace deburr::bench {
namespace {

constexpr int not_installed = 127;

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

}  // namespace

std::optional<double> cpu_seconds_of_program(const std::vector<std::string>& words, const std::string& log) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("cannot start " + words[0]);
    if (child == 0) {
        const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out, 1);
        dup2(out, 2);
        execvp(arguments[0], arguments.data());
        _exit(not_installed);
    }
    int status = 0;
    rusage used{};
    if (wait4(child, &status, 0, &used) != child) throw std::runtime_error("lost " + words[0]);
    if (WIFEXITED(status) && WEXITSTATUS(status) == not_installed) return std::nullopt;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(words[0] + " failed");
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "deburr-bench-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("cannot create a folder for the benchmark's files");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string deburr_program() { return DEBURR_PROGRAM; }

}  // namespace deburr::bench
