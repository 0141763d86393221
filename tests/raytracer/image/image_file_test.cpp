// Picture files in every format: layers, precision, headers, crops, and reading back.
#include "raytracer/image/image_file.hpp"

#include <cmath>
#include <cstring>

#include "catch.hpp"
#include "raytracer/folder.hpp"
#include "raytracer/picture_file.hpp"
#include "raytracer/util/errors.hpp"

using namespace deburr;
using namespace deburr::test;

namespace {

// A film whose pixels all differ; pixel (0, 0) hit nothing.
Film film(Window window = {0, 0, 20, 70}, const std::vector<ImageLayer>& layers = all_layers()) {
    Film film(20, 70, window, layers);
    for (int y = window.y; y < window.y + window.height; ++y)
        for (int x = window.x; x < window.x + window.width; ++x) {
            if (x == 0 && y == 0) continue;
            const double k = x + 20 * y;
            film.at(x, y) = {.color = {k / 1400, 0.5, 2.0 * k}, .alpha = 0.25};
            PixelLayers p;
            p.position = {k, -k, 0.1 * k};
            p.normal = {0.6, 0.0, -0.8};
            p.z = 3 + k;
            p.albedo = {0.1, 0.2, 0.3};
            p.guide_normal = {0.5, -0.25, 0.125};
            p.id = std::uint32_t(4'000'000'000 + k);  // not representable as a float
            p.cost = k + 0.5;
            film.set_layers({x, y, 1, 1}, &p);
        }
    return film;
}

ImageNotes notes() {
    ImageNotes notes;
    notes.spp = 4;
    notes.date = "2026:01:02 03:04:05";
    notes.render_seconds = 1.5;
    notes.attributes = {{"scene", "a scene.lua"}, {"parameter.r", "0.1"}};
    return notes;
}

// The types of a PNG's chunks, in order.
std::vector<std::string> png_chunks(const std::string& bytes) {
    std::vector<std::string> types;
    for (std::size_t at = 8; at + 8 <= bytes.size();) {
        std::size_t length = 0;
        for (std::size_t k = 0; k < 4; ++k) length = length << 8 | static_cast<unsigned char>(bytes[at + k]);
        types.push_back(bytes.substr(at + 4, 4));
        at += length + 12;
    }
    return types;
}

}  // namespace

TEST_CASE("an EXR gives back every layer") {
    const Folder folder;
    const Film original = film();
    write_image(folder / "a.exr", original, {}, notes());
    const PictureFile r = read_back(folder / "a.exr");
    CHECK(r.channels.size() == 19 + 2 * SolidShares::ranks);  // with Cryptomatte's channels
    CHECK(r.types[r.channel("R")] == "half");
    CHECK(r.types[r.channel("A")] == "half");
    CHECK(r.types[r.channel("id")] == "uint");
    for (const char* name :
         {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z", "Albedo.R", "Albedo.G", "Albedo.B", "cost"}) {
        CAPTURE(name);
        CHECK(r.types[r.channel(name)] == "float");
    }
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 20; ++x) {
            const Pixel& p = original.at(x, y);
            const auto kept = [&](ImageLayer layer, int k = 0) {
                return float(original.layer(layer).at(original.index(x, y), k));
            };
            for (int k = 0; k < 3; ++k) {
                REQUIRE(r.at(x, y, std::string("P.") + "XYZ"[k]) == kept(ImageLayer::position, k));
                REQUIRE(r.at(x, y, std::string("N.") + "XYZ"[k]) == kept(ImageLayer::normal, k));
                REQUIRE(r.at(x, y, std::string("Albedo.") + "RGB"[k]) == kept(ImageLayer::albedo, k));
                REQUIRE(r.at(x, y, std::string("Normal.") + "XYZ"[k]) == kept(ImageLayer::guide_normal, k));
            }
            REQUIRE(r.at(x, y, "Z") == kept(ImageLayer::z));
            REQUIRE(r.at(x, y, "cost") == kept(ImageLayer::cost));
            REQUIRE(r.at(x, y, "A") == float(p.alpha));
            REQUIRE(std::abs(r.at(x, y, "R") - p.color.x) <= p.color.x * 0x1p-11);  // half an ulp of a half float
            REQUIRE(r.at(x, y, "id") == std::uint32_t(original.layer(ImageLayer::id).at(original.index(x, y))));
        }
    CHECK(r.at(0, 0, "Z") == std::numeric_limits<float>::infinity());
    CHECK(r.at(0, 0, "N.X") == 0);
    CHECK(r.at(0, 0, "id") == 0);
}

TEST_CASE("an EXR holds the layers that the film keeps, and other files do not depend on them") {
    const Folder folder;
    const Window all{0, 0, 20, 70};
    write_image(folder / "a.exr", film(all, {}), {}, notes());
    CHECK(read_back(folder / "a.exr").channels == std::vector<std::string>{"R", "G", "B", "A"});
    write_image(folder / "a.exr", film(all, {ImageLayer::id}), {}, notes());
    CHECK(read_back(folder / "a.exr").channels == std::vector<std::string>{"R", "G", "B", "A", "id"});
    for (const char* name : {"a.png", "a.hdr", "a.jpg"}) {
        CAPTURE(name);
        write_image(folder / name, film(all, {}), {}, notes());
        const std::string without = read_file(folder / name);
        write_image(folder / name, film(), {}, notes());
        CHECK(read_file(folder / name) == without);
    }
}

TEST_CASE("with --float colours keep 32 bits; half is clamped to finite values") {
    const Folder folder;
    Film bright = film();
    bright.at(3, 3).color = {1e6, -1e6, infinity};
    write_image(folder / "half.exr", bright, {}, notes());
    write_image(folder / "float.exr", bright, {true}, notes());
    const PictureFile half = read_back(folder / "half.exr"), full = read_back(folder / "float.exr");
    CHECK(half.at(3, 3, "R") == 65504);
    CHECK(half.at(3, 3, "G") == -65504);
    CHECK(half.at(3, 3, "B") == 65504);
    CHECK(full.at(3, 3, "R") == 1e6f);
    CHECK(full.at(7, 9, "R") == float(bright.at(7, 9).color.x));
    CHECK(full.types[full.channel("R")] == "float");
}

TEST_CASE("an EXR's header says what the picture is") {
    const Folder folder;
    write_image(folder / "a.exr", film(), {}, notes());
    const PictureFile a = read_back(folder / "a.exr");
    CHECK(a.attribute<std::string>("compression") == "zip");
    CHECK(a.attribute<std::string>("Software") == "Deburr " DEBURR_VERSION);
    CHECK(a.attribute<std::string>("DateTime") == "2026:01:02 03:04:05");
    CHECK(a.attribute<std::string>("deburr.scene") == "a scene.lua");
    CHECK(a.attribute<std::string>("deburr.parameter.r") == "0.1");
    CHECK(a.attribute<int>("samplesPerPixel") == 4);
    CHECK(a.attribute<float>("renderTimeSeconds") == 1.5f);
    CHECK(std::holds_alternative<Matrix44>(a.attributes.at("worldToCamera")));
    CHECK(std::holds_alternative<Matrix44>(a.attributes.at("worldToNDC")));
    CHECK(a.attributes.count("deburr.incomplete") == 0);
    // The attributes have the names of OpenEXR's standard, not those that OpenImageIO translates them to.
    const std::string bytes = read_file(folder / "a.exr");
    for (const char* name : {"worldToCamera", "worldToNDC", "capDate", "utcOffset"})
        CHECK(bytes.find(name + std::string(1, '\0')) != std::string::npos);
}

TEST_CASE("an incomplete picture is marked") {
    const Folder folder;
    Film part = film();
    part.complete = false;
    write_image(folder / "a.exr", part, {}, notes());
    write_image(folder / "a.png", part, {}, notes());
    CHECK(read_back(folder / "a.exr").attribute<int>("deburr.incomplete") == 1);
    CHECK(read_back(folder / "a.png").attribute<std::string>("deburr.incomplete") == "1");
}

TEST_CASE("a crop is a data window inside the display window, with the whole picture's pixels") {
    const Folder folder;
    write_image(folder / "all.exr", film(), {}, notes());
    const PictureFile all = read_back(folder / "all.exr");
    for (const Window w : {Window{5, 2, 7, 65}, Window{19, 69, 1, 1}, Window{0, 1, 20, 16}}) {
        write_image(folder / "part.exr", film(w), {}, notes());
        const PictureFile part = read_back(folder / "part.exr");
        CHECK(Window{part.x, part.y, part.width, part.height} == w);
        CHECK(part.full_x == 0);
        CHECK(part.full_y == 0);
        CHECK(part.full_width == 20);
        CHECK(part.full_height == 70);
        REQUIRE(part.channels == all.channels);
        for (int y = w.y; y < w.y + w.height; ++y)
            for (int x = w.x; x < w.x + w.width; ++x)
                for (const std::string& c : part.channels) REQUIRE(part.at(x, y, c) == all.at(x, y, c));
    }
}

TEST_CASE("the sRGB curve") {
    // IEC 61966-2-1 has two branches; 0.18 is middle grey.
    const std::pair<double, int> table[] = {{-1, 0},     {0, 0},     {0.001, 3},      {0.0031308, 10},
                                            {0.18, 118}, {0.5, 188}, {0.99999, 255},  {1, 255},
                                            {7, 255},    {NAN, 0},   {infinity, 255}, {-infinity, 0}};
    for (const auto& [linear, byte] : table) {
        CAPTURE(linear);
        CHECK(int(srgb_byte(linear)) == byte);
    }
}

TEST_CASE("the sRGB curve in bytes is its formula, at its steps too") {
    const auto formula = [](double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; };
    constexpr double rounding = 1e-12;  // of the formula and its inverse, in units of 1
    int near_a_step = 0;
    const auto check = [&](double x) {
        const double exact = 255 * formula(x);
        if (std::abs(exact - std::floor(exact) - 0.5) < rounding * 255) return ++near_a_step, void();
        CAPTURE(x);
        REQUIRE(int(srgb_byte(x)) == int(std::lround(exact)));
    };
    for (int i = 0; i <= 300'000; ++i) check(i / 300'000.0);
    for (int i = 0; i < 4096; ++i) {
        check(std::nextafter(i / 4096.0, 0));
        check(i / 4096.0);
    }
    for (int byte = 1; byte < 256; ++byte) {
        const double v = (byte - 0.5) / 255, step = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        check(step * (1 - 1e-9));
        check(step * (1 + 1e-9));
    }
    CHECK(near_a_step < 10);
}

TEST_CASE("a PNG is opaque 8 bit sRGB and says so") {
    const Folder folder;
    const Film original = film();
    write_image(folder / "a.png", original, {}, notes());
    const PictureFile a = read_back(folder / "a.png");
    CHECK(a.types == std::vector<std::string>{"uint8", "uint8", "uint8"});
    REQUIRE(a.bytes.size() == 20 * 70 * 3);
    for (int y = 0; y < 70; ++y)
        for (int x = 0; x < 20; ++x)
            for (int k = 0; k < 3; ++k) REQUIRE(a.bytes[(y * 20 + x) * 3 + k] == srgb_byte(original.at(x, y).color[k]));
    const auto chunks = png_chunks(read_file(folder / "a.png"));
    CHECK(std::count(chunks.begin(), chunks.end(), "sRGB") == 1);
    CHECK(std::count(chunks.begin(), chunks.end(), "IEND") == 1);
}

TEST_CASE("a cropped PNG has the crop's size") {
    const Folder folder;
    write_image(folder / "a.png", film({5, 2, 7, 9}), {}, notes());
    const PictureFile a = read_back(folder / "a.png");
    CHECK(a.width == 7);
    CHECK(a.height == 9);
    CHECK(a.x == 0);
}

TEST_CASE("every format that is known can be written and read back") {
    const Folder folder;
    Film grey = film();  // since .hdr has one exponent for a pixel's three colours
    for (Pixel& pixel : grey.pixels) pixel.color = Vec3(0.5);
    std::string all = known_extensions() + ", ";
    int formats = 0;
    for (std::size_t at = 0, end; (end = all.find(", ", at)) != std::string::npos; at = end + 2, ++formats) {
        const std::string name = std::string("a").append(all, at, end - at);
        CAPTURE(name);
        REQUIRE(image_kind(name));
        double share = 0;
        write_image(folder / name, grey, {}, notes(), [&](double s) {
            CHECK(s >= share);
            share = s;
        });
        CHECK(share == 1);
        const PictureFile r = read_back(folder / name);
        CHECK(r.width == 20);
        CHECK(r.height == 70);
        // Lossy formats may be off by a few steps of 1/255.
        const float expected = *image_kind(name) == ImageKind::display ? 188 / 255.0f : 0.5f;
        CHECK(std::abs(r.at(10, 40, "G") - expected) < 6 / 255.0f);
    }
    CHECK(formats == 9);
    CHECK(folder.names().size() == 9);
}

TEST_CASE("the same film and notes give the same bytes") {
    const Folder folder;
    for (const char* name : {".exr", ".png", ".jpg"}) {
        CAPTURE(name);
        const std::string a = folder / std::string("a").append(name);
        const std::string b = folder / std::string("b").append(name);
        write_image(a, film(), {}, notes());
        write_image(b, film(), {}, notes());
        CHECK(read_file(a) == read_file(b));
    }
}

TEST_CASE("a picture that cannot be written is an error and leaves nothing") {
    const Folder folder;
    write_file(folder / "file", "");
    CHECK_THROWS_AS(write_image(folder / "none/a.exr", film(), {}, notes()), WorkError);
    CHECK_THROWS_AS(write_image(folder / "file/a.exr", film(), {}, notes()), WorkError);
    CHECK(folder.names() == std::vector<std::string>{"file"});
}
