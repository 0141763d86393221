#include "raytracer/view/file_watch.hpp"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

constexpr std::uint32_t events = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE;
// An editor causes several events when it saves; within this time of each other they are one change.
constexpr int settled_milliseconds = 25;

}  // namespace

FileWatch::FileWatch() : descriptor_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    if (descriptor_ < 0) throw WorkError(std::string("cannot watch files: ") + std::strerror(errno));
}

FileWatch::~FileWatch() { close(descriptor_); }

void FileWatch::set_files(const std::vector<std::string>& paths) {
    std::map<std::string, std::vector<std::string>> names;
    for (const std::string& path : paths) {
        const std::filesystem::path file(path);
        const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
        names[folder].push_back(file.filename().string());
    }
    std::vector<Folder> folders;
    std::set<int> kept;
    for (const auto& [folder, files] : names) {
        const int watch =
            inotify_add_watch(descriptor_, folder.c_str(), events);  // an existing watch is returned again
        if (watch < 0) throw WorkError("cannot watch '" + folder + "': " + std::strerror(errno));
        kept.insert(watch);
        folders.push_back({watch, files});
    }
    for (const Folder& old : folders_)
        if (kept.count(old.watch) == 0) inotify_rm_watch(descriptor_, old.watch);
    folders_ = std::move(folders);
}

bool FileWatch::take_events() {
    alignas(inotify_event) std::array<char, 16384> buffer;
    bool any = false;
    for (ssize_t size; (size = read(descriptor_, buffer.data(), buffer.size())) > 0;)
        for (const char* at = buffer.data(); at < buffer.data() + size;) {
            const auto* event = reinterpret_cast<const inotify_event*>(at);
            at += sizeof(inotify_event) + event->len;
            for (const Folder& folder : folders_)
                if (folder.watch == event->wd && event->len > 0)
                    any = any || std::count(folder.names.begin(), folder.names.end(), event->name) > 0;
        }
    return any;
}

bool FileWatch::wait(int milliseconds) {
    pollfd waited{descriptor_, POLLIN, 0};
    bool any = false;
    while (poll(&waited, 1, any ? settled_milliseconds : milliseconds) > 0) {
        any = take_events() || any;
        if (!any) break;
    }
    return any;
}

}  // namespace deburr
