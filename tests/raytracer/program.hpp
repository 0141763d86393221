// Runs the program as a user would, and gives it a scene to work on. The program is the one of the tests' build, or
// that of the environment's DEBURR_PROGRAM.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "raytracer/folder.hpp"

namespace deburr::test {

struct Outcome {
    int code = -1;  // exit code; 128 + signal if one ended it
    std::string out, err;
};

/// A call under way.
class Call {
public:
    /// `words` follow the program's name; `environment` are NAME=value.
    explicit Call(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    void send(int signal);
    bool running();
    /// Waits until stderr holds `text`, for a minute at most; false: it never did.
    bool says(const std::string& text);
    /// The first line of stdout, waited for a minute at most; "": none came.
    std::string first_line();
    /// Waits until the program has a handler of its own for a signal, for a minute at most; false: it never had.
    bool handles(int signal);
    Outcome wait();

private:
    Folder folder_;
    pid_t pid_ = -1;
    int status_ = 0;
    bool ended_ = false;
};

/// The lines of stderr that do not tell how far the work is, which only runs of a second and more do.
std::string without_progress(const std::string& err);

Outcome run(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});

/// A rounded cube over a floor, 60 x 40, seen from above; parameters: r, the radius.
std::string cube_scene();

}  // namespace deburr::test
