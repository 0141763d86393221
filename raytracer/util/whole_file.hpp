// Files that appear whole or not at all.
//
// The bytes go to a hidden file in the same folder, are flushed to the disk and take the name in
// one step; whoever looks sees the old file or the new one. A symbolic link keeps pointing to the
// file it names. Who writes a hidden file holds a lock on it (flock); those that nobody holds any more, of runs that
// were killed, are removed by the next run that writes to the folder. Devices and pipes (/dev/stdout) have nothing to
// replace and are written directly.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// Throws WorkError unless `path` can be created or replaced as far as can be known now. Leaves
/// nothing behind.
void check_writable(const std::string& path);

/// Throws WorkError and leaves what was there before if anything fails.
void write_whole_file(const std::string& path, std::string_view bytes);

struct FileBytes {
    std::string path;
    std::string bytes;
};

/// Files that belong together, at most two: all are on the disk before the first of them takes its name. Throws
/// WorkError, and leaves what was there before if any of them cannot be written.
void write_whole_files(const std::vector<FileBytes>& files);

/// Removes the hidden files that are being written, if any; for use in a signal handler that ends the
/// process.
void remove_unfinished_files() noexcept;

/// Whether this process has written any file, or a part of one that is written directly; for use in a signal handler.
bool any_file_written() noexcept;

}  // namespace deburr
