#include "raytracer/image/picture_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace deburr {
namespace {

using namespace std::string_view_literals;

// Most bytes that a byte decompresses to: 1032 for deflate (a match of 258 in two bits); run lengths, LZW and Huffman
// codes stay below. DWA deflates one number for 8 x 8 pixels.
constexpr double deflate = 1032, dwa = 64 * deflate;
// Headers, and what a format needs for the smallest picture, take fewer bytes than this.
constexpr double always = 1 << 20;
// A lossless WebP of a single colour has a few bytes at any size.
constexpr double always_of_webp = 1 << 24;

// Random access to the bytes of a file.
class File {
public:
    explicit File(const std::string& path) : in_(path, std::ios::binary) {
        in_.seekg(0, std::ios::end);
        size_ = in_ ? std::int64_t(in_.tellg()) : -1;
        if (size_ < 0) throw std::runtime_error("expected a file that can be read");
    }

    std::int64_t size() const { return size_; }
    /// At most `count` bytes from `at` on; fewer at the end.
    std::string bytes(std::int64_t at, std::int64_t count) {
        count = std::clamp<std::int64_t>(size_ - at, 0, count);
        std::string read(std::size_t(count), '\0');
        in_.clear();
        if (!in_.seekg(at) || !in_.read(read.data(), count))
            throw std::runtime_error("expected a file that can be read");
        return read;
    }
    std::uint64_t little_endian(std::int64_t at, std::int64_t count) {
        const std::string read = whole(at, count);
        std::uint64_t number = 0;
        for (auto c = read.rbegin(); c != read.rend(); ++c) number = number << 8 | static_cast<unsigned char>(*c);
        return number;
    }
    std::uint64_t big_endian(std::int64_t at, std::int64_t count) {
        std::uint64_t number = 0;
        for (const char c : whole(at, count)) number = number << 8 | static_cast<unsigned char>(c);
        return number;
    }
    /// The text from `at` to the next 0, at most 255 characters [OpenEXR: file layout].
    std::string name(std::int64_t at) {
        const std::string read = bytes(at, 256);
        const std::size_t end = read.find('\0');
        if (end == std::string::npos) throw std::runtime_error("expected a header with names, got one that is cut off");
        return read.substr(0, end);
    }

private:
    std::string whole(std::int64_t at, std::int64_t count) {
        std::string read = bytes(at, count);
        if (std::int64_t(read.size()) < count) throw std::runtime_error("expected a header, got one that is cut off");
        return read;
    }
    std::ifstream in_;
    std::int64_t size_ = 0;
};

std::int64_t as_signed(std::uint64_t word) { return std::int32_t(std::uint32_t(word)); }

// Bits per pixel: the sum over the channels' types [OpenEXR: file layout, chlist].
double exr_pixel_bits(File& file, std::int64_t at, std::int64_t end) {
    constexpr std::int64_t after_name = 16;  // type, flags, sampling
    double bits = 0;
    while (at < end) {
        const std::string name = file.name(at);
        if (name.empty()) break;
        at += std::int64_t(name.size()) + 1;
        bits += file.little_endian(at, 4) == 1 ? 16 : 32;
        at += after_name;
    }
    return bits;
}

// Checks the attributes of all parts, since OpenEXR allocates memory for as long a text as an attribute claims. The
// size is that of the first part.
PictureHeader read_exr(File& file) {
    PictureHeader header{"openexr", 0, 0, 0, deflate, always};
    const bool parts = file.little_endian(4, 4) & 0x1000;
    std::int64_t at = 8;
    for (bool first = true;; first = false) {
        std::string name = file.name(at);
        if (name.empty()) break;  // after the last of several parts
        for (; !name.empty(); name = file.name(at)) {
            at += std::int64_t(name.size()) + 1;
            at += std::int64_t(file.name(at).size()) + 1;  // skips its type
            const std::int64_t size = as_signed(file.little_endian(at, 4));
            at += 4;
            if (size < 0 || size > file.size() - at)
                throw std::runtime_error(
                    fmt::format("expected a file that holds the {} bytes of its header's '{}', got {} bytes", size,
                                name.substr(0, 31), file.size()));
            if (first && name == "dataWindow") {
                header.width = as_signed(file.little_endian(at + 8, 4)) - as_signed(file.little_endian(at, 4)) + 1;
                header.height =
                    as_signed(file.little_endian(at + 12, 4)) - as_signed(file.little_endian(at + 4, 4)) + 1;
            } else if (first && name == "channels") {
                header.pixel_bits = exr_pixel_bits(file, at, at + size);
            } else if (first && name == "compression") {
                constexpr int dwaa = 8;  // 9 is DWA with more lines a block
                if (file.little_endian(at, 1) >= dwaa) header.expansion = dwa;
            }
            at += size;
        }
        ++at;
        if (!parts) break;
    }
    return header;
}

// Reads the header chunk [PNG §11.2.1].
PictureHeader read_png(File& file) {
    const std::uint64_t type = file.big_endian(25, 1);
    return {"png",
            std::int64_t(file.big_endian(16, 4)),
            std::int64_t(file.big_endian(20, 4)),
            double(file.big_endian(24, 1)) * (type == 2   ? 3
                                              : type == 4 ? 2
                                              : type == 6 ? 4
                                                          : 1),
            deflate,
            always};
}

// Reads the first start-of-frame segment [ITU T.81 §B.2.2].
PictureHeader read_jpeg(File& file) {
    for (std::int64_t at = 2;;) {
        const std::uint64_t marker = file.big_endian(at, 2);
        if (marker >> 8 != 0xff) throw std::runtime_error("expected a JPEG of segments, got something between them");
        if (marker == 0xffff) {  // fill bytes
            ++at;
        } else if (marker >= 0xffc0 && marker <= 0xffcf && marker != 0xffc4 && marker != 0xffc8 && marker != 0xffcc) {
            return {"jpeg",
                    std::int64_t(file.big_endian(at + 7, 2)),
                    std::int64_t(file.big_endian(at + 5, 2)),
                    8.0 * double(file.big_endian(at + 9, 1)),
                    deflate,
                    always};
        } else if (marker == 0xffda || marker == 0xffd9) {
            throw std::runtime_error("expected a JPEG with a frame, got none");
        } else {
            at += 2 + std::int64_t(file.big_endian(at + 2, 2));
        }
    }
}

// The picture is in the first chunk, or that chunk has its size [RFC 9649 §2.5 to 2.7, RFC 6386 §9.1].
PictureHeader read_webp(File& file) {
    PictureHeader header{"webp", 0, 0, 32, deflate, always_of_webp};
    const std::string chunk = file.bytes(12, 4);
    if (chunk == "VP8 ") {
        header.width = std::int64_t(file.little_endian(26, 2) & 0x3fff);
        header.height = std::int64_t(file.little_endian(28, 2) & 0x3fff);
    } else if (chunk == "VP8L") {
        const std::uint64_t sizes = file.little_endian(21, 4);
        header.width = std::int64_t(sizes & 0x3fff) + 1;
        header.height = std::int64_t(sizes >> 14 & 0x3fff) + 1;
    } else {
        header.width = std::int64_t(file.little_endian(24, 3)) + 1;
        header.height = std::int64_t(file.little_endian(27, 3)) + 1;
    }
    return header;
}

PictureHeader read_bmp(File& file) {
    const bool old = file.little_endian(14, 4) == 12;  // OS/2 header, with numbers of two bytes
    const int bytes = old ? 2 : 4;
    const auto number = [&](std::int64_t at) {
        const std::uint64_t word = file.little_endian(at, bytes);
        return old ? std::int64_t(word) : as_signed(word);
    };
    // A negative height means that rows are stored from the top.
    return {"bmp",   number(18), std::abs(number(18 + bytes)), double(file.little_endian(old ? 24 : 28, 2)),
            deflate, always};
}

PictureHeader read_tga(File& file) {
    return {"targa",
            std::int64_t(file.little_endian(12, 2)),
            std::int64_t(file.little_endian(14, 2)),
            double(file.little_endian(16, 1)),
            deflate,
            always};
}

// The numbers in a text, separated by spaces and comments.
class Numbers {
public:
    explicit Numbers(std::string text) : text_(std::move(text)) {}
    std::int64_t next() {
        for (; at_ < text_.size() && !std::isdigit(static_cast<unsigned char>(text_[at_])); ++at_)
            if (text_[at_] == '#') at_ = std::min(text_.find('\n', at_), text_.size() - 1);
        std::int64_t number = 0;
        constexpr std::int64_t most = std::int64_t(1) << 31;
        for (; at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])); ++at_)
            number = std::min(10 * number + (text_[at_] - '0'), most);
        return number;
    }

private:
    std::string text_;
    std::size_t at_ = 0;
};

constexpr std::int64_t text_header = 4096;  // bytes that are searched

PictureHeader read_pnm(File& file) {
    const char kind = file.bytes(1, 1)[0];
    Numbers numbers(file.bytes(2, text_header));
    const std::int64_t width = numbers.next(), height = numbers.next();
    const double bits = kind == '4' ? 1 : kind == '3' || kind == '6' ? 24 : 8;
    return {"pnm", width, height, bits, 1, always};
}

// Reads "-Y height +X width", which follows the header's empty line.
PictureHeader read_hdr(File& file) {
    const std::string text = file.bytes(0, text_header);
    const std::size_t end = text.find("\n\n");
    if (end == std::string::npos) throw std::runtime_error("expected a header that ends, got none");
    Numbers numbers(text.substr(end + 2));
    const std::int64_t height = numbers.next();
    return {"hdr", numbers.next(), height, 32, deflate, always};
}

struct Format {
    std::int64_t at;  // offset of the mark; from the end if negative
    std::string_view mark;
    PictureHeader (*read)(File&);
};

constexpr Format formats[] = {
    {0, "\x76\x2f\x31\x01"sv, read_exr},
    {0, "\x89PNG\r\n\x1a\n"sv, read_png},
    {0, "\xff\xd8\xff"sv, read_jpeg},
    {8, "WEBPVP8"sv, read_webp},
    {0, "#?RADIANCE"sv, read_hdr},
    {0, "BM"sv, read_bmp},
    {-18, "TRUEVISION-XFILE.\0"sv, read_tga},
    {0, "P1"sv, read_pnm},
    {0, "P2"sv, read_pnm},
    {0, "P3"sv, read_pnm},
    {0, "P4"sv, read_pnm},
    {0, "P5"sv, read_pnm},
    {0, "P6"sv, read_pnm},
};

}  // namespace

PictureHeader read_picture_header(const std::string& path) {
    File file(path);
    for (const Format& format : formats) {
        const std::int64_t at = format.at < 0 ? file.size() + format.at : format.at;
        if (at < 0 || file.bytes(at, std::int64_t(format.mark.size())) != format.mark) continue;
        const PictureHeader header = format.read(file);
        if (header.width <= 0 || header.height <= 0 || header.pixel_bits <= 0)
            throw std::runtime_error("expected a picture with pixels, got none");
        const double claimed = double(header.width) * double(header.height) * header.pixel_bits / 8;
        if (claimed > header.always && claimed > header.expansion * double(file.size()))
            throw std::runtime_error(
                fmt::format("expected a file that holds the {}x{} pixels of its header, got {} bytes", header.width,
                            header.height, file.size()));
        return header;
    }
    throw std::runtime_error("expected an EXR, PNG, JPEG, BMP, TGA, PPM, WebP or HDR");
}

}  // namespace deburr
