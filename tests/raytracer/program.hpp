// Runs the program as a user would: the program of the tests' build, or that of the environment variable
// DEBURR_PROGRAM.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "raytracer/folder.hpp"

namespace deburr::test {

struct Outcome {
    int code = -1;  // exit code, or 128 + the signal that ended the program
    std::string out, err;
};

/// A running process of the program; the destructor kills it if it still runs.
class Call {
public:
    /// Starts the program with the arguments `words` and the settings `environment`, each as NAME=value.
    explicit Call(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    void send(int signal);
    bool running();
    /// Waits until stderr contains `text`, for at most a minute; false if it does not or the program ends first.
    bool says(const std::string& text);
    /// Waits for the first line of stdout, for at most a minute; "" if none comes.
    std::string first_line();
    /// Waits until the program handles this signal itself, for at most a minute; false if it does not.
    bool handles(int signal);
    /// Waits for the program's end.
    Outcome wait();

private:
    Folder folder_;
    pid_t pid_ = -1;
    int status_ = 0;
    bool ended_ = false;
};

/// The lines of stderr without those of progress, which only runs of at least a second print.
std::string without_progress(const std::string& err);

/// Runs the program to its end.
Outcome run(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});

/// Waits for so many seconds.
void pause_for(double seconds);

/// A rounded cube on a floor seen from above, 60 × 40 pixels; its parameter r is the radius.
std::string cube_scene();

}  // namespace deburr::test
