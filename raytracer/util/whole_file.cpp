#include "raytracer/util/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

// The hidden file's name for a signal handler. One file is written at a time.
std::atomic<const char*> unfinished{nullptr};
static_assert(std::atomic<const char*>::is_always_lock_free);
std::atomic<bool> file_written{false};

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw WorkError(fmt::format("cannot write '{}': {}", path, why));
}

[[noreturn]] void fail(const std::string& path, int error) { fail(path, std::strerror(error)); }

constexpr std::string_view prefix = ".deburr-", suffix = ".tmp";

bool is_hidden_name(std::string_view name) {
    if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size())
        return false;
    name = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
    return name.find_first_not_of("0123456789-") == std::string_view::npos;
}

// Our user's hidden files that no process holds a lock on. It fails without a word: what matters is the file to write.
void remove_left_behind(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> done;
    const std::lock_guard once(mutex);
    if (!done.insert(folder).second) return;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        if (!is_hidden_name(at->path().filename().native())) continue;
        const int file = open(at->path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (file < 0) continue;
        struct stat status {};
        if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
            flock(file, LOCK_EX | LOCK_NB) == 0)
            unlink(at->path().c_str());
        close(file);
    }
}

// A file of ours that vanishes unless it was given its final name.
class HiddenFile {
public:
    HiddenFile(const std::string& path, const fs::path& folder) : path_(path) {
        remove_left_behind(folder);
        for (int n = 0; descriptor_ < 0; ++n) {
            name_ = (folder / fmt::format("{}{}-{}{}", prefix, getpid(), n, suffix)).string();
            unfinished = name_.c_str();  // before there is one, or a signal in between would leave it
            descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno == EEXIST) continue;
            if (descriptor_ < 0) {
                unfinished = nullptr;
                fail(path, errno);
            }
            struct stat status {};
            flock(descriptor_, LOCK_EX);  // not every file system has locks: then nobody gets one
            if (fstat(descriptor_, &status) == 0 && status.st_nlink == 0) {  // it was removed before it was locked
                close(descriptor_);
                descriptor_ = -1;
            }
        }
    }
    ~HiddenFile() {
        if (descriptor_ >= 0) close(descriptor_);
        if (!kept_) unlink(name_.c_str());
        unfinished = nullptr;
    }
    HiddenFile(const HiddenFile&) = delete;
    HiddenFile& operator=(const HiddenFile&) = delete;

    int descriptor() const { return descriptor_; }

    void keep_as(const fs::path& target, mode_t mode) {
        if (mode && fchmod(descriptor_, mode) != 0) fail(path_, errno);
        if (fsync(descriptor_) != 0) fail(path_, errno);
        const int closed = close(descriptor_);
        descriptor_ = -1;
        if (closed != 0) fail(path_, errno);
        if (rename(name_.c_str(), target.c_str()) != 0) fail(path_, errno);
        kept_ = file_written = true;
    }

private:
    std::string path_, name_;
    int descriptor_ = -1;
    bool kept_ = false;
};

struct Target {
    fs::path file, folder;
    bool direct = false;  // a device or a pipe
    mode_t mode = 0;      // of the file that is there, 0: none is
};

Target find_target(const std::string& path) {
    Target target;
    target.file = path;
    struct stat status {};
    if (stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) fail(path, "it is a folder");
        if (access(path.c_str(), W_OK) != 0) fail(path, errno);
        target.direct = !S_ISREG(status.st_mode);
        target.mode = status.st_mode & 07777;
        if (!target.direct) target.file = fs::canonical(path);
    } else if (errno != ENOENT) {
        fail(path, errno);
    } else {
        // Where a link points to that names no file yet; links in a circle were an error above.
        while (fs::is_symlink(target.file)) target.file = target.file.parent_path() / fs::read_symlink(target.file);
    }
    target.folder = target.file.parent_path();
    if (target.folder.empty()) target.folder = ".";
    return target;
}

void write_all(const std::string& path, int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = write(descriptor, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(path, errno);
        bytes.remove_prefix(std::size_t(n));
    }
}

}  // namespace

void check_writable(const std::string& path) {
    const Target target = find_target(path);
    if (!target.direct) HiddenFile probe(path, target.folder);
}

void write_whole_file(const std::string& path, std::string_view bytes) {
    const Target target = find_target(path);
    if (target.direct) {
        const int descriptor = open(path.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor < 0) fail(path, errno);
        file_written = true;
        try {
            write_all(path, descriptor, bytes);
        } catch (...) {
            close(descriptor);
            throw;
        }
        if (close(descriptor) != 0) fail(path, errno);
        return;
    }
    HiddenFile file(path, target.folder);
    write_all(path, file.descriptor(), bytes);
    file.keep_as(target.file, target.mode);
    // The name itself lasts only once the folder is on the disk too; not every file system can.
    const int folder = open(target.folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
        fsync(folder);
        close(folder);
    }
}

void remove_unfinished_file() noexcept {
    if (const char* name = unfinished.load()) unlink(name);
}

bool any_file_written() noexcept { return file_written.load(); }

}  // namespace deburr
