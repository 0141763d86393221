// Runs the program as a user would, and gives it a folder and a scene to work on.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace deburr::test {

/// A fresh folder that vanishes with everything in it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    /// Path of a file in it.
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    /// Names of all that is in it, hidden files too, in order.
    std::vector<std::string> names() const;

private:
    std::filesystem::path path_;
};

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
    /// Waits until the program has a handler of its own for a signal, for a minute at most; false: it never had.
    bool handles(int signal);
    Outcome wait();

private:
    Folder folder_;
    pid_t pid_ = -1;
    int status_ = 0;
    bool ended_ = false;
};

Outcome run(const std::vector<std::string>& words, const std::vector<std::string>& environment = {});

std::string read_file(const std::string& path);
void write_file(const std::string& path, const std::string& text);

/// A rounded cube over a floor, 60 x 40, seen from above; parameters: r, the radius.
std::string cube_scene();

}  // namespace deburr::test
