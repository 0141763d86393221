// Watches files by their folders, since editors replace files and do not write into them (inotify).
#pragma once
#include <string>
#include <vector>

namespace deburr {

class FileWatch {
public:
    /// Throws WorkError where the system has no watches left.
    FileWatch();
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// Watches these files from now on, and no others, whether they are there or not.
    void set_files(const std::vector<std::string>& paths);
    /// Whether one of them was written, replaced or removed; waits so long for it, and then until nothing more has
    /// happened for a moment.
    bool wait(int milliseconds);

private:
    struct Folder {
        int watch;
        std::vector<std::string> names;
    };
    bool take_events();
    int descriptor_ = -1;
    std::vector<Folder> folders_;
};

}  // namespace deburr
