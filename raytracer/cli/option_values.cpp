#include "raytracer/cli/option_values.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>

#include "raytracer/scene/scene.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

[[noreturn]] void expected_value(std::string_view option, const std::string& what, std::string_view found) {
    throw UsageError(fmt::format("{}: expected {}, got '{}'", option, what, found));
}

// A number that consists of digits only, without sign or blanks.
std::optional<std::uint64_t> digits(std::string_view text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || at != end || text.empty()) return std::nullopt;
    return value;
}

std::optional<std::int64_t> whole(std::string_view text, std::int64_t least, std::int64_t most) {
    const auto value = digits(text);
    if (!value || *value > std::uint64_t(most) || std::int64_t(*value) < least) return std::nullopt;
    return std::int64_t(*value);
}

// The number; NaN if the text is not a finite number.
double number_of(std::string_view text) {
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && std::isfinite(x) ? x : std::nan("");
}

// Parses "A,B,C"; a part that is not a number becomes NaN.
std::optional<Vec3> three_numbers(std::string_view text) {
    const std::size_t first = text.find(','), second = text.find(',', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) return std::nullopt;
    return Vec3(number_of(text.substr(0, first)), number_of(text.substr(first + 1, second - first - 1)),
                number_of(text.substr(second + 1)));
}

// Parses "AxB".
std::optional<Size> sides(std::string_view text, int largest) {
    const std::size_t x = text.find('x');
    if (x == std::string_view::npos) return std::nullopt;
    const auto width = whole(text.substr(0, x), 1, largest);
    const auto height = whole(text.substr(x + 1), 1, largest);
    if (!width || !height) return std::nullopt;
    return Size{int(*width), int(*height)};
}

}  // namespace

std::int64_t parse_whole(std::string_view option, std::string_view text, std::int64_t least, std::int64_t most) {
    if (const auto value = whole(text, least, most)) return *value;
    expected_value(option, fmt::format("a whole number from {} to {}", least, most), text);
}

double parse_positive(std::string_view option, std::string_view text) {
    const double x = number_of(text);
    if (x > 0) return x;
    expected_value(option, "a number > 0", text);
}

double parse_limit(std::string_view option, std::string_view text) {
    const double x = number_of(text);
    if (x >= 0) return x;
    expected_value(option, "a number >= 0", text);
}

double parse_exposure(std::string_view option, std::string_view text) {
    const double x = number_of(text.substr(text.starts_with('+')));
    if (std::abs(x) <= max_exposure) return x;
    expected_value(option, fmt::format("a number from {0} to {1}", -max_exposure, max_exposure), text);
}

Vec3 parse_direction(std::string_view option, std::string_view text) {
    if (const auto v = three_numbers(text)) {
        const double size = largest(*v);
        if (size > 0 && std::isfinite(size)) return glm::normalize(*v / size);
    }
    expected_value(option, "X,Y,Z, not all 0, for example 1,0.5,2", text);
}

Vec3 parse_color(std::string_view option, std::string_view text) {
    const auto v = three_numbers(text);
    if (v && v->x >= 0 && v->x <= 1 && v->y >= 0 && v->y <= 1 && v->z >= 0 && v->z <= 1) return *v;
    expected_value(option, "R,G,B, each from 0 to 1, for example 0.8,0.4,0.1", text);
}

void parse_keep_sharp(std::string_view option, std::string_view text, KeepSharp& keep) {
    const auto after = [&](std::string_view sign) {
        return text.starts_with(sign) ? std::optional(text.substr(sign.size())) : std::nullopt;
    };
    if (text == "convex" || text == "concave") {
        keep.edges = text == "convex" ? KeptEdges::Kind::convex : KeptEdges::Kind::concave;
        return;
    }
    if (const auto height = after("below=")) {
        const double h = number_of(*height);
        if (std::isfinite(h)) return void(keep.below = std::max(h, keep.below.value_or(h)));
    }
    if (const auto height = after("above=")) {
        const double h = number_of(*height);
        if (std::isfinite(h)) return void(keep.above = std::min(h, keep.above.value_or(h)));
    }
    if (const auto corners = after("box=")) {
        std::size_t comma = 0;
        for (int k = 0; k < 3 && comma != std::string_view::npos; ++k) comma = corners->find(',', comma + (k > 0));
        if (comma != std::string_view::npos) {
            const auto a = three_numbers(corners->substr(0, comma)), b = three_numbers(corners->substr(comma + 1));
            if (a && b && std::isfinite(a->x + a->y + a->z + b->x + b->y + b->z))
                return keep.boxes.push_back({glm::min(*a, *b), glm::max(*a, *b)});
        }
    }
    expected_value(option, "convex, concave, below=H, above=H or box=X,Y,Z,X,Y,Z", text);
}

char parse_axis(std::string_view option, std::string_view text) {
    if (text == "y" || text == "z") return text[0];
    expected_value(option, "y or z", text);
}

std::string parse_word(std::string_view option, std::string_view text, const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& word : words) {
        if (text == word) return word;
        all += (all.empty() ? "" : &word == &words.back() ? " or " : ", ") + word;
    }
    expected_value(option, all, text);
}

std::uint64_t parse_seed(std::string_view option, std::string_view text) {
    if (const auto value = digits(text)) return *value;
    expected_value(option, "a whole number from 0 to 2^64-1", text);
}

Size parse_size(std::string_view option, std::string_view text) {
    const auto size = sides(text, largest_picture_side);
    if (!size) expected_value(option, fmt::format("WxH, each from 1 to {}", largest_picture_side), text);
    return *size;
}

void check_pixels(std::string_view option, const Window& window) {
    if (std::int64_t(window.width) * window.height > max_pixels || std::max(window.width, window.height) > largest_side)
        expected_value(
            option,
            fmt::format("at most {} pixels and {} a side at once (--crop renders parts)", max_pixels, largest_side),
            fmt::format("{}x{}", window.width, window.height));
}

Window parse_crop(std::string_view option, std::string_view text) {
    const std::size_t first = text.find('+');
    const std::size_t second = first == std::string_view::npos ? first : text.find('+', first + 1);
    if (second != std::string_view::npos) {
        const auto size = sides(text.substr(0, first), largest_side);
        const auto x = whole(text.substr(first + 1, second - first - 1), 0, largest_picture_side);
        const auto y = whole(text.substr(second + 1), 0, largest_picture_side);
        if (size && x && y) return {int(*x), int(*y), size->width, size->height};
    }
    expected_value(option, "WxH+X+Y, for example 100x50+20+10", text);
}

void check_crop(std::string_view option, const Window& crop, Size picture) {
    if (crop.x + crop.width > picture.width || crop.y + crop.height > picture.height)
        expected_value(option, fmt::format("a window within the picture of {}x{}", picture.width, picture.height),
                       fmt::format("{}x{}+{}+{}", crop.width, crop.height, crop.x, crop.y));
}

std::vector<ImageLayer> parse_layers(std::string_view option, std::string_view text) {
    std::string known;
    for (const ImageLayer layer : all_layers())
        known += fmt::format("{}{}", known.empty() ? "" : ", ", layer_name(layer));
    std::vector<ImageLayer> layers;
    for (std::string_view rest = text;;) {
        const std::size_t comma = rest.find(',');
        const std::string_view name = rest.substr(0, comma);
        const auto layer = find_layer(name);
        if (!layer) expected_value(option, "some of " + known, name);
        layers.push_back(*layer);
        if (comma == std::string_view::npos) return layers;
        rest.remove_prefix(comma + 1);
    }
}

Criterion parse_criterion(std::string_view option, std::string_view text) {
    if (text == "exact") return Criterion::exact;
    if (text == "lobb") return Criterion::lobb;
    expected_value(option, "exact or lobb", text);
}

IntegratorKind parse_integrator(std::string_view option, std::string_view text) {
    if (text == "path") return IntegratorKind::path;
    if (text == "preview") return IntegratorKind::preview;
    expected_value(option, "path or preview", text);
}

Accel parse_accel(std::string_view option, std::string_view text) {
    if (text == "bvh" || text == "bsp") return Accel::bvh;  // bsp is the older name
    if (text == "embree") return Accel::embree;
    expected_value(option, "bvh or embree", text);
}

MeshMethod parse_mesh_method(const std::string& option, const std::string& name) {
    if (name == "triage") return MeshMethod::triage;
    if (name == "marching-cubes") return MeshMethod::marching_cubes;
    if (name == "octree") return MeshMethod::octree;
    expected_value(option, mesh_method_names(), name);
}

double parse_tolerance(const std::string& text) {
    return text == "inf" ? infinity : parse_positive("--tolerance", text);
}

MeshSettings picture_mesh_settings(const std::string& via, const std::string& tolerance) {
    MeshSettings settings = picture_mesh_settings();
    if (!via.empty()) settings.method = parse_mesh_method("--via", via);
    if (!tolerance.empty()) {
        settings.tolerance_in_radii = settings.tolerance_in_sizes = infinity;
        settings.tolerance = parse_tolerance(tolerance);
    }
    return settings;
}

void parse_define(std::string_view option, std::string_view text, std::map<std::string, std::string>& defines) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const std::size_t equals = text.find('=');
    bool fine = equals != std::string_view::npos && equals > 0 && equals + 1 < text.size() && letter(text[0]);
    for (std::size_t i = 1; fine && i < equals; ++i) fine = letter(text[i]) || (text[i] >= '0' && text[i] <= '9');
    if (!fine) expected_value(option, "name=value", text);
    const std::string name(text.substr(0, equals)), value(text.substr(equals + 1));
    if (!defines.emplace(name, value).second) expected_value(option, fmt::format("'{}' once", name), text);
}

void check_image_names(std::string_view option, const std::vector<std::string>& paths) {
    for (const std::string& path : paths)
        if (!image_kind(path)) expected_value(option, "a file name that ends in " + known_extensions(), path);
    check_distinct(paths);
}

namespace {

namespace fs = std::filesystem;

// An identity that is the same for all paths of one file: its device and inode if it exists, else its canonical path.
std::string identity(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) == 0) return fmt::format("{}:{}", status.st_dev, status.st_ino);
    fs::path file = path;
    std::error_code error;  // errors of access are reported when the file is written
    for (int links = 0; links < 40 && fs::is_symlink(file, error); ++links)
        file = file.parent_path() / fs::read_symlink(file, error);
    fs::path canonical = fs::weakly_canonical(fs::absolute(file, error), error);
    return error ? path : canonical.string();
}

bool is_regular(const std::string& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

void check_distinct(const std::vector<std::string>& paths) {
    std::set<std::string> seen;
    for (const std::string& path : paths)
        if (!seen.insert(identity(path)).second) expected_value("outputs", "different files", path);
}

void check_outputs(std::vector<std::string> outputs, const std::vector<std::string>& more_outputs,
                   const std::vector<std::string>& inputs) {
    for (const std::string& path : more_outputs)
        if (!path.empty()) outputs.push_back(path);
    check_distinct(outputs);
    for (const std::string& input : inputs) {
        if (!is_regular(input)) continue;  // a terminal may be both read and written
        for (const std::string& output : outputs)
            if (identity(output) == identity(input))
                expected_value("outputs", fmt::format("other files than the input '{}'", input), output);
    }
}

}  // namespace deburr
