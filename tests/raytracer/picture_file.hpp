// Pictures read back from files by OpenImageIO, whatever wrote them: a reader that is not the program's own.
//
// OpenImageIO is in a module that is loaded with the first picture (raytracer/util/module.hpp), for a test program that
// is linked with it takes half a second to begin, and CTest begins it for every case.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "raytracer/image/image_raster.hpp"

namespace deburr::test {

struct PictureFile {
    int x = 0, y = 0, width = 0, height = 0;                      // the pixels that the file stores
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;  // the whole picture
    std::vector<std::string> channels;
    std::vector<std::string> types;    // of the channels' numbers: half, float, uint, uint8 or uint16
    std::vector<unsigned char> bytes;  // rows of pixels, and in a pixel the channels' numbers in their own types
    std::vector<double> values;        // the same numbers; those of uint8 and uint16 divided by their type's greatest
    std::map<std::string, ImageAttribute::second_type> attributes;  // as text where the type is none of these

    /// The index of a channel; a failure of the test if there is none.
    std::size_t channel(const std::string& name) const;
    std::size_t pixel_bytes() const { return bytes.size() / (std::size_t(width) * std::size_t(height)); }
    /// The bytes of the pixel at (x, y) of the whole picture.
    const unsigned char* pixel(int at_x, int at_y) const { return &bytes[index(at_x, at_y) * pixel_bytes()]; }
    /// The value of a channel at (x, y) of the whole picture.
    double at(int at_x, int at_y, std::size_t channel) const {
        return values[index(at_x, at_y) * channels.size() + channel];
    }
    double at(int at_x, int at_y, const std::string& name) const { return at(at_x, at_y, channel(name)); }
    /// The attribute's value if there is one of this name and type, `otherwise` if not.
    template <class Type>
    Type attribute(const std::string& name, Type otherwise = {}) const {
        const auto found = attributes.find(name);
        const Type* value = found == attributes.end() ? nullptr : std::get_if<Type>(&found->second);
        return value ? *value : otherwise;
    }

private:
    std::size_t index(int at_x, int at_y) const {
        return std::size_t(at_y - y) * std::size_t(width) + std::size_t(at_x - x);
    }
};

/// Reads a picture; colours are weighed by alpha or not as they are in the file. Throws std::runtime_error if the file
/// is not a picture that can be read to its end.
PictureFile read_back(const std::string& path);

/// The type and name of the function that the module exports.
using PictureReader = void(const char* path, PictureFile& picture);
constexpr const char* picture_reader = "deburr_read_picture";

}  // namespace deburr::test
