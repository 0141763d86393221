// A ZIP archive in memory, by minizip. Its bytes depend on what is put in and on zlib alone: all files are dated
// 1980-01-01, the first day that the format knows.
#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace deburr {

class ZipArchive {
public:
    ZipArchive();
    ~ZipArchive();
    ZipArchive(const ZipArchive&) = delete;
    ZipArchive& operator=(const ZipArchive&) = delete;

    /// Begins a file; what is added goes there until the next one begins. Throws std::length_error if the last one
    /// has 4 GiB or more.
    void begin(const std::string& name);
    void add(std::string_view bytes);
    /// Ends the archive and returns its bytes. Throws as begin().
    std::string finish();

private:
    struct Output;
    void end_file();

    std::unique_ptr<Output> output_;
};

}  // namespace deburr
