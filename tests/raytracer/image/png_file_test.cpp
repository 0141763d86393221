// PNG files decoded by libpng at its strictest and by OpenImageIO.
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/program.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

using Bytes = std::vector<unsigned char>;

struct Picture {
    int width, height;
    Bytes rgb;

    /// byte(x, y, channel) returns a channel's value.
    template <class Byte>
    Picture(int columns, int rows, Byte byte) : width(columns), height(rows) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int k = 0; k < 3; ++k) rgb.push_back(static_cast<unsigned char>(byte(x, y, k)));
    }

    ImageRaster raster() const {
        ImageRaster image{
            width, height, {0, 0, width, height}, {}, {{"Software", "a test"}, {"DateTime", "2026:01:02 03:04:05"}}};
        for (std::size_t k = 0; k < 3; ++k)
            image.channels.push_back(image_channel(std::string(1, "RGB"[k]), ChannelType::byte,
                                                   [this, k](std::size_t i) { return rgb[3 * i + k]; }));
        return image;
    }
};

unsigned hashed(unsigned n) {
    n = (n ^ n >> 16) * 0x45d9f3bu;
    n = (n ^ n >> 16) * 0x45d9f3bu;
    return n >> 16;
}

Picture noise(int width, int height) {
    return {width, height, [=](int x, int y, int k) { return hashed(unsigned((y * width + x) * 3 + k)); }};
}

struct Chunk {
    std::string type;
    Bytes data;
};

std::vector<Chunk> chunks_of(const std::string& png) {
    std::vector<Chunk> chunks;
    const auto* bytes = reinterpret_cast<const unsigned char*>(png.data());
    for (std::size_t at = 8; at < png.size();) {
        const std::size_t size = png_get_uint_32(bytes + at);
        REQUIRE(at + 12 + size <= png.size());
        chunks.push_back({png.substr(at + 4, 4), Bytes(bytes + at + 8, bytes + at + 8 + size)});
        at += 12 + size;
    }
    return chunks;
}

// The zlib stream of the file's rows.
Bytes compressed_rows(const std::string& png) {
    Bytes all;
    for (const Chunk& c : chunks_of(png))
        if (c.type == "IDAT") all.insert(all.end(), c.data.begin(), c.data.end());
    return all;
}

// The rows before compression: each has a byte for the filter's type, then the filtered bytes.
Bytes rows_of(const std::string& png) {
    const Bytes packed = compressed_rows(png), header = chunks_of(png).at(0).data;
    const std::size_t width = png_get_uint_32(&header[0]), height = png_get_uint_32(&header[4]);
    Bytes rows((1 + 3 * width) * height + 1);  // one more byte than allowed, to see an excess
    uLongf size = rows.size();
    REQUIRE(uncompress(rows.data(), &size, packed.data(), packed.size()) == Z_OK);
    rows.resize(size);
    return rows;
}

// The decoded pixels; throws where libpng would only warn, too.
Bytes strictly_decoded(const std::string& file) {
    struct Reader {
        png_structp png = png_create_read_struct(
            PNG_LIBPNG_VER_STRING, nullptr, [](png_structp, png_const_charp what) { throw std::runtime_error(what); },
            [](png_structp, png_const_charp what) { throw std::runtime_error(what); });
        png_infop info = png_create_info_struct(png);
        ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    } r;
    std::string_view rest = file;
    png_set_read_fn(r.png, &rest, [](png_structp p, png_bytep to, std::size_t n) {
        auto& left = *static_cast<std::string_view*>(png_get_io_ptr(p));
        if (left.size() < n) throw std::runtime_error("the file ends early");
        left.copy(reinterpret_cast<char*>(to), n);
        left.remove_prefix(n);
    });
    png_set_benign_errors(r.png, 0);
    png_set_crc_action(r.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(r.png, r.info);
    const std::size_t row = png_get_rowbytes(r.png, r.info), height = png_get_image_height(r.png, r.info);
    Bytes bytes(row * height);
    for (std::size_t y = 0; y < height; ++y) png_read_row(r.png, &bytes[y * row], nullptr);
    png_read_end(r.png, r.info);
    if (!rest.empty()) throw std::runtime_error("the file goes on");
    return bytes;
}

// Writes the picture as a file, checks that both readers decode its pixels, and returns the file's bytes.
std::string checked_file(const Picture& picture) {
    const Folder folder;
    write_raster(folder / "a.png", picture.raster());
    const std::string file = read_file(folder / "a.png");
    CHECK((strictly_decoded(file) == picture.rgb));  // in parentheses, or Catch2 would print all bytes
    const PictureFile other = read_back(folder / "a.png");
    REQUIRE(other.width == picture.width);
    REQUIRE(other.height == picture.height);
    REQUIRE(other.types == std::vector<std::string>{"uint8", "uint8", "uint8"});
    CHECK((other.bytes == picture.rgb));
    return file;
}

}  // namespace

TEST_CASE("a PNG gives back every pixel, whatever the picture") {
    const auto ramp = [](int x, int y, int k) { return 3 * x + 5 * y + 70 * k; };
    const auto flat = [](int, int, int k) { return 200 - k; };
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 2}, {2, 1}, {3, 70}, {1, 300}, {100'000, 2}, {64, 64}, {65, 129}}) {
        CAPTURE(width, height);
        checked_file(noise(width, height));
        checked_file({width, height, ramp});
        checked_file({width, height, flat});
        // Rows with either filter, in turn.
        checked_file({width, height, [&](int x, int y, int k) { return y % 3 ? flat(x, y, k) : ramp(x, y, k); }});
    }
}

TEST_CASE("a PNG's rows are as they are where neighbours are often equal, else differences from the left") {
    const Picture picture(90, 40, [](int x, int y, int k) { return y < 25 ? 10 + k : 2 * x + k; });
    const Bytes rows = rows_of(checked_file(picture));
    REQUIRE(rows.size() == 40 * (1 + 3 * 90));
    for (std::size_t y = 0; y < 40; ++y)
        CHECK(int(rows[y * (1 + 3 * 90)]) == (y < 25 ? PNG_FILTER_VALUE_NONE : PNG_FILTER_VALUE_SUB));
}

TEST_CASE("a large PNG's data are in chunks of up to 1 MiB that follow each other") {
    constexpr std::size_t longest = 1 << 20;
    const auto chunks = chunks_of(checked_file(noise(1000, 900)));
    std::vector<std::string> types;
    std::vector<std::size_t> sizes;
    for (const Chunk& c : chunks) {
        types.push_back(c.type);
        if (c.type == "IDAT") sizes.push_back(c.data.size());
    }
    REQUIRE(types.size() == 10);
    std::sort(types.begin() + 1, types.begin() + 6);  // the order of these chunks depends on libpng's version
    CHECK(types ==
          std::vector<std::string>{"IHDR", "cHRM", "gAMA", "sRGB", "tEXt", "tIME", "IDAT", "IDAT", "IDAT", "IEND"});
    REQUIRE(sizes.size() == 3);
    CHECK(sizes[0] == longest);
    CHECK(sizes[1] == longest);
    CHECK((sizes[2] > 0 && sizes[2] <= longest));
}

TEST_CASE("what writes a PNG tells how far it is") {
    const Picture picture = noise(20, 200);
    std::vector<double> reported;
    encode_png(picture.raster(), [&](double share) { reported.push_back(share); });
    CHECK(reported.size() == 4);
    CHECK(std::is_sorted(reported.begin(), reported.end()));
    CHECK((reported.front() > 0 && reported.back() < 1));
}

TEST_CASE("PNGs of nearly flat scenes are at most 2 % larger than zlib's level 6 makes them", "[slow]") {
    const Folder folder;
    for (const auto& [scene, size] : {std::pair{"first", "600x380"},
                                      {"first", "300x190"},
                                      {"csg_examples", "600x380"},
                                      {"csg_examples", "900x570"}}) {
        CAPTURE(scene, size);
        REQUIRE(run({"render", DEBURR_SOURCE_DIR "/scenes/" + std::string(scene) + ".lua", "-q", "--size", size, "-o",
                     folder / "a.png"})
                    .code == 0);
        const std::string file = read_file(folder / "a.png");
        const Bytes rows = rows_of(file);
        Bytes zlib(compressBound(rows.size()));
        uLongf length = zlib.size();
        REQUIRE(compress2(zlib.data(), &length, rows.data(), rows.size(), 6) == Z_OK);
        CHECK(double(compressed_rows(file).size()) <= 1.02 * double(length));
    }
}
