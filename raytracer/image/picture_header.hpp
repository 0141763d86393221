// What a picture file says of itself, by its bytes and not by its name: its format, and how many pixels it claims to
// hold.
//
// Readers of pictures get memory for what a header claims before they find out that the file is shorter. So that is
// checked here, before one of them sees the file.
#pragma once
#include <cstdint>
#include <string>

namespace deburr {

struct PictureHeader {
    const char* format = nullptr;        // OpenImageIO's name of it
    std::int64_t width = 0, height = 0;  // of what is stored
    double pixel_bits = 0;               // before they are compressed
    double expansion = 1;                // the most bytes that the format makes of one
    double always = 0;                   // bytes that are believed whatever the file's size
};

/// The header of a file of one of the formats that are written (image_format.hpp). Throws std::runtime_error if it is
/// of none of them, cannot be read, or is too small to hold the pixels, or the parts of its header, that it claims.
PictureHeader read_picture_header(const std::string& path);

}  // namespace deburr
