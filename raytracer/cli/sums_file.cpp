#include "raytracer/cli/sums_file.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view magic = "deburr sums 1\n";

std::string whole_file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string bytes;
    if (in) bytes.assign(std::istreambuf_iterator<char>(in), {});
    if (!in && !in.eof()) throw WorkError(fmt::format("cannot read '{}': {}", path, std::strerror(errno)));
    return bytes;
}

template <class Number>
void append(std::string& bytes, Number number) {
    for (std::size_t i = 0; i < sizeof number; ++i) bytes.push_back(char(number >> 8 * i & 255));
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
    Number number = 0;
    for (std::size_t i = sizeof number; i > 0; --i)
        number = number << 8 | static_cast<unsigned char>(bytes[at + i - 1]);
    return number;
}

Json vec_head(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3 vec_of(const Json& j) { return {j.at(0), j.at(1), j.at(2)}; }

}  // namespace

void write_sums(const std::string& path, const SumsFile& file) {
    std::string bytes(magic);
    const std::string head = file.head.dump(-1, ' ', false, Json::error_handler_t::replace);
    bytes.reserve(magic.size() + 12 + head.size() + file.bytes.size());
    append(bytes, std::uint64_t(head.size()));
    bytes += head;
    bytes += file.bytes;
    append(bytes, std::uint32_t(libdeflate_crc32(0, bytes.data(), bytes.size())));
    write_whole_file(path, bytes);
}

SumsFile read_sums(const std::string& path) {
    const std::string all = whole_file(path);
    const std::string_view bytes = all;
    if (bytes.substr(0, magic.size()) != magic)
        throw WorkError(fmt::format("{}: expected a file of sums by --checkpoint, got another one", path));
    constexpr std::size_t ends = 8 + 4;
    if (bytes.size() < magic.size() + ends ||
        number_at<std::uint32_t>(bytes, bytes.size() - 4) != libdeflate_crc32(0, bytes.data(), bytes.size() - 4))
        throw WorkError(fmt::format("{}: expected the sums that were written, got a damaged file", path));
    const std::size_t size = number_at<std::uint64_t>(bytes, magic.size()), begin = magic.size() + 8;
    if (size > bytes.size() - begin - 4) throw WorkError(fmt::format("{}: expected a head, got a damaged file", path));
    SumsFile file{Json::parse(bytes.substr(begin, size)),
                  std::string(bytes.substr(begin + size, bytes.size() - 4 - begin - size))};
    if (file.head.at("version") != DEBURR_VERSION)
        throw WorkError(fmt::format("{}: expected sums of deburr {}, got those of {}", path, DEBURR_VERSION,
                                    file.head.at("version").get<std::string>()));
    return file;
}

Json window_head(const Window& w) { return {w.x, w.y, w.width, w.height}; }
Window window_of(const Json& j) { return {j.at(0), j.at(1), j.at(2), j.at(3)}; }

Json notes_head(const ImageNotes& notes, const ImageFormat& format, Denoiser denoiser) {
    const Camera& c = notes.camera;
    Json j;
    j["camera"] = {{"eye", vec_head(c.eye)}, {"target", vec_head(c.target)},   {"up", vec_head(c.up)},
                   {"fov", c.fov},           {"orthographic", c.orthographic}, {"lens", c.lens_radius},
                   {"focus", c.focus},       {"shift", vec_head(c.shift)}};
    j["attributes"] = notes.attributes;
    j["solids"] = notes.solids;
    j["format"] = {{"float", format.float_color},
                   {"bits", format.bits},
                   {"alpha", format.alpha},
                   {"exposure", format.exposure},
                   {"agx", format.view == ViewTransform::agx},
                   {"denoiser", name(denoiser)}};
    return j;
}

void read_notes(const Json& j, ImageNotes& notes, ImageFormat& format, Denoiser& denoiser) {
    const Json& c = j.at("camera");
    notes.camera = {vec_of(c.at("eye")),  vec_of(c.at("target")), vec_of(c.at("up")), c.at("fov"),
                    c.at("orthographic"), c.at("lens"),           c.at("focus"),      vec_of(c.at("shift"))};
    notes.attributes = j.at("attributes").get<decltype(notes.attributes)>();
    notes.solids = j.at("solids").get<std::vector<std::string>>();
    const Json& f = j.at("format");
    format.float_color = f.at("float");
    format.bits = f.at("bits");
    format.alpha = f.at("alpha");
    format.exposure = f.at("exposure");
    format.view = f.at("agx").get<bool>() ? ViewTransform::agx : ViewTransform::standard;
    denoiser = find_denoiser(f.at("denoiser").get<std::string>()).value();
}

void ContentHash::add(std::string_view text) {
    const auto mix = [this](unsigned char c) { hash_ = (hash_ ^ c) * 0x100000001b3; };
    for (const char c : text) mix(static_cast<unsigned char>(c));
    // The length is hashed, too, so that boundaries between texts matter.
    for (std::size_t size = text.size(), i = 0; i < sizeof size; ++i) mix(static_cast<unsigned char>(size >> 8 * i));
}

void ContentHash::add_file(const std::string& path) { add(whole_file(path)); }

std::string ContentHash::text() const { return fmt::format("{:016x}", hash_); }

}  // namespace deburr
