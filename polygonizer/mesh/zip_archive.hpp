// Writes a ZIP archive in memory, by minizip. Its bytes depend on the content and on zlib alone: all files are dated
// 1980-01-01, the first day that the format knows.
#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace deburr {

/// An archive under construction. Throws std::bad_alloc where memory runs out.
class ZipArchive {
public:
    ZipArchive();
    ~ZipArchive();
    ZipArchive(const ZipArchive&) = delete;
    ZipArchive& operator=(const ZipArchive&) = delete;

    /// Begins a file of the archive, to which add() appends until the next begin(). Throws std::length_error if the
    /// previous file has 4 GiB or more.
    void begin(const std::string& name);
    void add(std::string_view bytes);
    /// Completes the archive and returns its bytes; call it once, last. Throws as begin() does.
    std::string finish();

private:
    struct Output;
    void end_file();

    std::unique_ptr<Output> output_;
};

}  // namespace deburr
