// Reads a picture file's format and size from its bytes, regardless of its name, and checks that the file can hold the
// pixels that it claims.
//
// Readers of pictures allocate the memory that a header claims before they notice that the file is shorter, so this is
// checked first.
#pragma once
#include <cstdint>
#include <string>

namespace deburr {

/// The claims of a file's header.
struct PictureHeader {
    const char* format = nullptr;        // OpenImageIO's name of the format
    std::int64_t width = 0, height = 0;  // of the stored picture
    double pixel_bits = 0;               // bits per pixel before compression
    double expansion = 1;                // the most bytes that the format decompresses a byte to
    double always = 0;                   // a claim of up to this many bytes is accepted at any file size
};

/// Reads the header of a file in one of the formats that are written (image_format.hpp). Throws std::runtime_error if
/// the file has none of these formats, cannot be read, or is too small for the pixels or the header's parts that it
/// claims.
PictureHeader read_picture_header(const std::string& path);

}  // namespace deburr
