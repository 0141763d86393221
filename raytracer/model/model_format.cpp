#include "raytracer/model/model_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "raytracer/util/printable.hpp"
#include "raytracer/util/scene_error.hpp"

namespace deburr {
namespace {

constexpr const char* extensions[] = {".stl", ".obj", ".ply", ".off", ".3mf", ".glb", ".gltf", ".scad", ".csg"};

char lower(unsigned char c) { return char(std::tolower(c)); }

std::string extension(const std::string& path) {
    std::string end = std::filesystem::path(path).extension().string();
    std::transform(end.begin(), end.end(), end.begin(), lower);
    return end;
}

// Sizes in bytes: 80 bytes of any text and a count, then 50 bytes for each facet.
constexpr std::size_t stl_header = 84, stl_facet = 50;

std::size_t stl_count(const std::string& bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= stl_header) std::memcpy(&count, bytes.data() + 80, 4);
    return count;
}

// A PLY reader allocates memory for as many elements as the header claims, so a claim of more than one per byte is
// refused.
void check_ply_counts(const std::string& bytes, const std::string& path) {
    const std::size_t end = std::min(bytes.find("end_header"), bytes.size());
    const std::string sign = "element ";
    for (std::size_t at = bytes.find(sign); at < end; at = bytes.find(sign, at + 1)) {
        const std::size_t number = bytes.find(' ', at + sign.size());
        if (number >= end) return;
        const double count = std::strtod(bytes.c_str() + number, nullptr);
        if (!(count <= double(bytes.size())))
            refuse_model(path, fmt::format("expected at most an element a byte, got a claim of {:.0f} in {} bytes",
                                           count, bytes.size()));
    }
}

}  // namespace

void refuse_model(const std::string& path, const std::string& what) {
    throw SceneError(one_line(fmt::format("{}: {}", file_mark, what), path));
}

void fold_stl_text(std::string& bytes) {
    const auto space = [](unsigned char c) { return std::isspace(c) != 0; };
    const std::size_t mark = bytes.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0;  // of UTF-8
    const auto begin = std::find_if_not(bytes.begin() + std::ptrdiff_t(mark), bytes.end(), space);
    const std::string sign = "solid";
    if (std::size_t(bytes.end() - begin) < sign.size()) return;
    if (!std::equal(sign.begin(), sign.end(), begin, [](char a, unsigned char b) { return a == lower(b); })) return;
    if (bytes.find('\0') != std::string::npos) return;  // binary STL, whose header may be any text
    bytes.erase(bytes.begin(), begin);
    std::transform(bytes.begin(), bytes.end(), bytes.begin(), lower);
}

bool is_model_path(const std::string& path) {
    const std::string end = extension(path);
    return std::find(std::begin(extensions), std::end(extensions), end) != std::end(extensions);
}

bool is_openscad_path(const std::string& path) {
    const std::string end = extension(path);
    return end == ".scad" || end == ".csg";
}

std::string model_format(const std::string& bytes, const std::string& path) {
    const auto starts = [&](const char* sign) { return bytes.compare(0, std::strlen(sign), sign) == 0; };
    if (bytes.empty()) refuse_model(path, "expected a model, got an empty file");
    if (starts("glTF")) return "glb";
    if (starts("PK\x03\x04")) return "3mf";
    if (starts("ply")) {
        check_ply_counts(bytes, path);
        return "ply";
    }
    const std::string end = extension(path);
    if (starts("OFF") || starts("COFF") || starts("NOFF") || starts("CNOFF")) return "off";
    if (end == ".obj") return "obj";
    if (end == ".gltf") return "gltf";
    const std::size_t count = stl_count(bytes);
    if (bytes.size() >= stl_header && bytes.size() == stl_header + stl_facet * count) {
        if (count == 0) refuse_model(path, "expected facets, got none");
        return "stl";
    }
    const bool is_text = bytes.find('\0') == std::string::npos;
    if (is_text && starts("solid") && bytes.find("facet") != std::string::npos) {
        if (bytes.find("endsolid") == std::string::npos)
            refuse_model(path, "expected STL text that ends with endsolid, got one that is cut off");
        return "stl";
    }
    if (end == ".stl" && !is_text && bytes.size() >= stl_header)
        refuse_model(path, fmt::format("expected {} bytes for the {} facets that it claims, got {}",
                                       stl_header + stl_facet * count, count, bytes.size()));
    refuse_model(path, "expected a model (STL, OBJ, PLY, OFF, 3MF, GLB), got something else");
}

}  // namespace deburr
