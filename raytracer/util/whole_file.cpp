#include "raytracer/util/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

namespace fs = std::filesystem;

// Names of the hidden files being written, for a signal handler. Only one group of files is written at a time.
constexpr std::size_t max_files = 2;
std::array<std::atomic<const char*>, max_files> unfinished{};
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

// Removes this user's hidden files that no process holds a lock on, once per folder. Errors are ignored: only the file
// to be written matters.
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

// A hidden file, locked while it exists; removed unless it was renamed to its final name.
class HiddenFile {
public:
    HiddenFile(const std::string& path, const fs::path& folder) : path_(path) {
        while (unfinished.at(slot_)) ++slot_;
        remove_left_behind(folder);
        for (int n = 0; descriptor_ < 0; ++n) {
            name_ = (folder / fmt::format("{}{}-{}{}", prefix, getpid(), n, suffix)).string();
            // Set before the file exists, or a signal in between would leave it behind.
            unfinished[slot_] = name_.c_str();
            descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (descriptor_ < 0 && errno == EEXIST) continue;
            if (descriptor_ < 0) {
                const int error = errno;
                unfinished[slot_] = nullptr;
                fail(path, error);
            }
            struct stat status {};
            flock(descriptor_, LOCK_EX);  // may fail where the file system has no locks; then no process gets one
            // Another process may have removed it before it was locked.
            if (fstat(descriptor_, &status) == 0 && status.st_nlink == 0) {
                close(descriptor_);
                descriptor_ = -1;
            }
        }
    }
    ~HiddenFile() {
        if (descriptor_ >= 0) close(descriptor_);
        if (!kept_) unlink(name_.c_str());
        unfinished[slot_] = nullptr;
    }
    HiddenFile(const HiddenFile&) = delete;
    HiddenFile& operator=(const HiddenFile&) = delete;

    int descriptor() const { return descriptor_; }

    /// Flushes the file to disk, with permissions `mode` unless 0.
    void sync(mode_t mode) {
        if (mode && fchmod(descriptor_, mode) != 0) fail(path_, errno);
        if (fsync(descriptor_) != 0) fail(path_, errno);
    }

    /// Renames the file. It stays locked until then, so that it is not taken for one left behind.
    void keep_as(const fs::path& target) {
        if (rename(name_.c_str(), target.c_str()) != 0) fail(path_, errno);
        kept_ = file_written = true;
    }

private:
    std::string path_, name_;
    int descriptor_ = -1;
    std::size_t slot_ = 0;  // in `unfinished`
    bool kept_ = false;
};

// The file that a path leads to, through links.
struct Target {
    fs::path file, folder;
    bool direct = false;  // a device or a pipe
    mode_t mode = 0;      // permissions of the existing file; 0: there is none
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
        // Follows a link that points to no file yet; circular links have failed above.
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

void write_directly(const std::string& path, std::string_view bytes) {
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
}

// Flushes the folder, without which the new name may be lost in a crash; file systems that cannot are tolerated.
void sync_folder(const fs::path& path) {
    const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
}

struct Output {
    const std::string& path;
    std::string_view bytes;
};

void write_together(const std::vector<Output>& outputs) {
    std::vector<Target> targets;
    for (const Output& o : outputs) targets.push_back(find_target(o.path));
    std::array<std::optional<HiddenFile>, max_files> files;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (targets[i].direct) continue;
        HiddenFile& file = files.at(i).emplace(outputs[i].path, targets[i].folder);
        write_all(outputs[i].path, file.descriptor(), outputs[i].bytes);
        file.sync(targets[i].mode);
    }
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (targets[i].direct) write_directly(outputs[i].path, outputs[i].bytes);
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (files[i]) files[i]->keep_as(targets[i].file);
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (files[i]) sync_folder(targets[i].folder);
}

}  // namespace

void check_writable(const std::string& path) {
    const Target target = find_target(path);
    if (!target.direct) HiddenFile probe(path, target.folder);
}

void write_whole_file(const std::string& path, std::string_view bytes) { write_together({{path, bytes}}); }

void write_whole_files(const std::vector<FileBytes>& files) {
    std::vector<Output> outputs;
    for (const FileBytes& f : files) outputs.push_back({f.path, f.bytes});
    write_together(outputs);
}

void remove_unfinished_files() noexcept {
    for (const std::atomic<const char*>& file : unfinished)
        if (const char* name = file.load()) unlink(name);
}

bool any_file_written() noexcept { return file_written.load(); }

}  // namespace deburr
