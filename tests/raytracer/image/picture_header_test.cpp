// Headers of picture files: sizes, cut-off files, false claims, and files of other kinds.
#include "raytracer/image/picture_header.hpp"

#include <cstring>

#include "catch.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/image/image_file.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// The bytes of a picture of 23 × 11 in the format of this extension.
std::string written(const Folder& folder, const std::string& extension) {
    const Film film(23, 11, {0, 0, 23, 11}, {});
    write_image(folder / ("a" + extension), film, {}, {});
    return read_file(folder / ("a" + extension));
}

std::vector<std::string> extensions() {
    std::vector<std::string> all;
    const std::string names = known_extensions() + ", ";
    for (std::size_t at = 0, end; (end = names.find(", ", at)) != std::string::npos; at = end + 2)
        all.push_back(names.substr(at, end - at));
    return all;
}

std::string refusal(const Folder& folder, const std::string& bytes) {
    write_file(folder / "b", bytes);
    try {
        read_picture_header(folder / "b");
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("the header of every format that is written tells the picture's size, whatever the file's name") {
    const Folder folder;
    int formats = 0;
    for (const std::string& extension : extensions()) {
        CAPTURE(extension);
        write_file(folder / "b", written(folder, extension));
        const PictureHeader header = read_picture_header(folder / "b");
        CHECK(header.width == 23);
        CHECK(header.height == 11);
        CHECK(header.pixel_bits >= 24);
        ++formats;
    }
    CHECK(formats == 9);
}

TEST_CASE("a picture's file that is cut off anywhere is refused in words, or its header is whole") {
    const Folder folder;
    for (const std::string& extension : extensions()) {
        const std::string bytes = written(folder, extension);
        CHECK(refusal(folder, bytes) == "");
        std::size_t refused = 0;
        for (std::size_t size = 0; size < std::min<std::size_t>(bytes.size(), 600); ++size) {
            CAPTURE(extension, size);
            const std::string words = refusal(folder, bytes.substr(0, size));
            if (words.empty()) continue;
            ++refused;
            CHECK(words.rfind("expected ", 0) == 0);
        }
        CHECK(refused >= 5);
    }
}

TEST_CASE("a picture's file is too small for the pixels that its header claims, in every format") {
    using namespace std::string_literals;
    const Folder folder;
    // Headers that claim 16,000 × 16,000 pixels in every format; 16,000 = 0x3e80.
    const std::string claims[] = {
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x3e\x80\0\0\x3e\x80\x08\x02\0\0\0"s,
        "\xff\xd8\xff\xe0\0\x04hi\xff\xff\xc2\0\x11\x08\x3e\x80\x3e\x80\x03"s,
        "RIFF\x10\0\0\0WEBPVP8 \x10\0\0\0\x30\0\0\x9d\x01\x2a\x80\x3e\x80\x3e"s,
        "RIFF\x10\0\0\0WEBPVP8L\x10\0\0\0\x2f\x7f\xfe\x9f\x0f\0"s,
        "RIFF\x10\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\x7f\x3e\0\x7f\x3e\0"s,
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n"s,
        "BM"s + std::string(12, 'x') + "\x28\0\0\0\x80\x3e\0\0\x80\xc1\xff\xff\x01\0\x18\0"s,
        "BM"s + std::string(12, 'x') + "\x0c\0\0\0\x80\x3e\x80\x3e\x01\0\x18\0"s,
        "\0\0\x0a\0\0\0\0\0\0\0\0\0\x80\x3e\x80\x3e\x18\0"s + "TRUEVISION-XFILE.\0"s,
        "P6 # a picture\n16000 16000 255\n"s,
        "P4\n16000 16000\n"s,
    };
    for (const std::string& bytes : claims) {
        CAPTURE(bytes);
        CHECK(refusal(folder, bytes) == "expected a file that holds the 16000x16000 pixels of its header, got " +
                                            std::to_string(bytes.size()) + " bytes");
    }
    std::string exr = written(folder, ".exr");
    const std::size_t window = exr.find("dataWindow\0box2i\0"s) + 17 + 4 + 8;
    exr.replace(window, 8, "\x7f\x3e\0\0\x7f\x3e\0\0"s);
    CHECK(refusal(folder, exr).find("the 16000x16000 pixels of its header") != std::string::npos);
}

TEST_CASE("an attribute of an EXR's header is as long as the file allows") {
    using namespace std::string_literals;
    const Folder folder;
    const std::string whole = written(folder, ".exr");
    const std::string mark = "compression\0compression\0"s;
    for (const std::string& size : {"\xff\xff\xff\x7f"s, "\0\0\0\x80"s, "\0\0\x10\0"s}) {
        std::string exr = whole;
        exr.replace(exr.find(mark) + mark.size(), 4, size);
        CHECK(refusal(folder, exr).find(" bytes of its header's 'compression', got " + std::to_string(exr.size())) !=
              std::string::npos);
    }
}

TEST_CASE("what is no picture is refused before any reader of pictures sees it") {
    const Folder folder;
    for (const char* bytes : {"", "P", "P7", "II*\1", "GIF89a", "return {}"})
        CHECK(refusal(folder, bytes) == "expected an EXR, PNG, JPEG, BMP, TGA, PPM, WebP or HDR");
    CHECK_THROWS_AS(read_picture_header(folder / "none"), std::runtime_error);
    CHECK_THROWS_AS(read_picture_header(folder / ""), std::runtime_error);  // a folder
}
