#include "raytracer/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace deburr::test {

Call::Call(const std::vector<std::string>& words, const std::vector<std::string>& environment) {
    const char* other = std::getenv("DEBURR_PROGRAM");
    std::vector<std::string> all = {other ? other : DEBURR_PROGRAM};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string out = folder_ / "out", err = folder_ / "err";
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    for (const std::string& setting : environment) putenv(const_cast<char*>(setting.c_str()));
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
}

Call::~Call() {
    if (!running()) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
}

void Call::send(int signal) {
    if (running()) kill(pid_, signal);
}

bool Call::running() {
    if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) != 0;
    return !ended_;
}

bool Call::says(const std::string& text) {
    for (int i = 0; i < 6000; ++i) {
        const bool last = !running();
        if (read_file(folder_ / "err").find(text) != std::string::npos) return true;
        if (last) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

std::string Call::first_line() {
    for (int i = 0; i < 6000; ++i) {
        const bool last = !running();
        const std::string out = read_file(folder_ / "out");
        if (const std::size_t end = out.find('\n'); end != std::string::npos) return out.substr(0, end);
        if (last) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return "";
}

bool Call::handles(int signal) {
    const std::string file = "/proc/" + std::to_string(pid_) + "/status", name = "SigCgt:";
    for (int i = 0; i < 60000 && running(); ++i) {
        const std::string status = read_file(file);
        const std::size_t at = status.find(name);
        const bool program = status.find("Name:\tdeburr") != std::string::npos;  // false until exec
        if (program && at != std::string::npos &&
            std::stoull(status.substr(at + name.size()), nullptr, 16) >> (signal - 1) & 1)
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

Outcome Call::wait() {
    if (running()) waitpid(pid_, &status_, 0);
    ended_ = true;
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, read_file(folder_ / "out"), read_file(folder_ / "err")};
}

std::string without_progress(const std::string& err) {
    std::istringstream lines(err);
    std::string rest;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t digit = std::min(line.find_first_not_of(' '), line.size());
        const std::size_t end = std::min(line.find_first_not_of("0123456789", digit), line.size());
        if (end == digit || line.compare(end, 4, " %  ") != 0) rest += line + "\n";
    }
    return rest;
}

Outcome run(const std::vector<std::string>& words, const std::vector<std::string>& environment) {
    return Call(words, environment).wait();
}

void pause_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

std::string cube_scene() {
    return R"(
local r = param("r", 0.1)
return {
  image = { width = 60, height = 40, spp = 1 },
  camera = { eye = {3, 2.5, 4}, target = {0.5, 0.5, 0.5}, up = {0, 1, 0}, fov = 30 },
  lights = { point_light{ position = {4, 6, 3}, color = {1, 1, 1}, power = 400 } },
  background = {0.6, 0.7, 0.8},
  solids = { rounded(r, cube()), sharp(box({-1, -1, -1}, {2, 0, 2})) },
}
)";
}

}  // namespace deburr::test
