// Writes files so that they appear whole or not at all.
//
// The bytes are written to a hidden file in the same folder, flushed to disk and renamed in one step, so that others
// see either the old file or the new one. A symbolic link keeps pointing to the file it names. A hidden file is locked
// (flock) while it is written; those without a lock, left by runs that were killed, are removed by the next run that
// writes to the folder. Devices and pipes (/dev/stdout) cannot be replaced and are written directly.
// replace and are written directly.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace deburr {

/// Throws WorkError if it is already clear that `path` cannot be created or replaced. Leaves nothing behind.
void check_writable(const std::string& path);

/// Writes the file. If that fails, throws WorkError and leaves the previous file as it was.
void write_whole_file(const std::string& path, std::string_view bytes);

/// A file to be written: its path and its content.
struct FileBytes {
    std::string path;
    std::string bytes;
};

/// Writes files that belong together, at most two: all are on disk before the first is renamed. Throws WorkError if one
/// cannot be written; then the previous files stay.
void write_whole_files(const std::vector<FileBytes>& files);

/// Removes hidden files that are being written; safe in a signal handler that ends the process.
void remove_unfinished_files() noexcept;

/// Whether this process has written a file, or part of one that is written directly; safe in a signal handler.
bool any_file_written() noexcept;

}  // namespace deburr
