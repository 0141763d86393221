// Watches files for changes (inotify), by their folders, since editors replace files instead of writing into them.
#pragma once
#include <string>
#include <vector>

namespace deburr {

/// Watches a set of files; used by one thread.
class FileWatch {
public:
    /// Throws WorkError if the system has no watches left.
    FileWatch();
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// Watches exactly these files from now on, whether they exist or not. Throws WorkError if a folder cannot be
    /// watched.
    void set_files(const std::vector<std::string>& paths);
    /// Whether one of the files was written, replaced or removed. Waits up to this time for a change, and after one
    /// until nothing more happens for a moment.
    bool wait(int milliseconds);

private:
    // A watched folder and the names of its watched files.
    struct Folder {
        int watch;
        std::vector<std::string> names;
    };
    bool take_events();
    int descriptor_ = -1;
    std::vector<Folder> folders_;
};

}  // namespace deburr
