#include "raytracer/image/image_difference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "raytracer/image/image_file.hpp"
#include "raytracer/image/image_module.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

constexpr double degrees = 180 / pi;

DifferenceFigures figures(std::vector<double>& values) {
    DifferenceFigures f;
    if (values.empty()) return f;
    std::sort(values.begin(), values.end());
    for (const double v : values) f.mean += v / double(values.size());
    f.p99 = values[std::min(values.size() - 1, std::size_t(0.99 * double(values.size())))];
    f.max = values.back();
    return f;
}

double angle(Vec3 a, Vec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * degrees; }

ReadImage colors(const Film& film) {
    ReadImage image{film.width, film.height, film.window, {"R", "G", "B"}, {}};
    for (const Pixel& p : film.pixels)
        for (int k = 0; k < 3; ++k) image.values.push_back(float(p.color[k]));
    return image;
}

// The values of pixel i in both pictures.
class Compared {
public:
    Compared(const Film& a, const Film& b) : a_(a), b_(b) {}

    const Film& first() const { return a_; }
    const Film& second() const { return b_; }
    bool both_keep(ImageLayer layer) const { return a_.keeps(layer) && b_.keeps(layer); }

    Vec3 color(std::size_t i) const { return a_.pixels[i].color - b_.pixels[i].color; }
    // The code that write_difference() stores as `hit`.
    int hit(std::size_t i) const {
        const bool in_a = a_.pixels[i].alpha > 0, in_b = b_.pixels[i].alpha > 0;
        if (in_a != in_b) return in_a ? 1 : 2;
        return both_keep(ImageLayer::id) && id(a_, i) != id(b_, i) ? 3 : 0;
    }
    double distance(std::size_t i) const {
        return glm::length(vec(a_, ImageLayer::position, i) - vec(b_, ImageLayer::position, i));
    }
    double angle(std::size_t i) const {
        return deburr::angle(vec(a_, ImageLayer::normal, i), vec(b_, ImageLayer::normal, i));
    }

    static std::uint32_t id(const Film& film, std::size_t i) {
        return film.keeps(ImageLayer::id) ? std::uint32_t(film.layer(ImageLayer::id).at(i)) : 0;
    }

private:
    static Vec3 vec(const Film& film, ImageLayer layer, std::size_t i) { return film.layer(layer).vec(i); }
    const Film &a_, &b_;
};

}  // namespace

std::vector<ImageLayer> compared_layers() { return {ImageLayer::position, ImageLayer::normal, ImageLayer::id}; }

PictureDifference difference(const Film& a, const Film& b, const std::vector<double>& radii) {
    const Compared both(a, b);
    const bool distances_known = both.both_keep(ImageLayer::position),
               angles_known = both.both_keep(ImageLayer::normal);
    PictureDifference d;
    d.pixels = a.pixels.size();
    d.in_radii = !radii.empty();
    double least = infinity;
    for (const double r : radii)
        if (r > 0) least = std::min(least, r);
    if (!(least < infinity)) d.in_radii = false;
    const auto radius = [&](std::uint32_t id) {
        if (!d.in_radii) return 1.0;
        return id >= 1 && id <= radii.size() && radii[id - 1] > 0 ? radii[id - 1] : least;
    };
    const auto counts = [&](const Film& film, std::size_t i) {
        const std::uint32_t id = Compared::id(film, i);
        return film.pixels[i].alpha > 0 && (!d.in_radii || (id >= 1 && id <= radii.size() && radii[id - 1] > 0));
    };
    std::vector<double> distances, angles;
    double squares = 0;
    for (std::size_t i = 0; i < d.pixels; ++i) {
        const Vec3 c = both.color(i);
        squares += glm::dot(c, c);
        if (!counts(a, i) && !counts(b, i)) continue;
        ++d.on_object;
        const int hit = both.hit(i);
        d.only_first += hit == 1;
        d.only_second += hit == 2;
        d.other_solid += hit == 3;
        if (hit != 0) continue;
        if (distances_known) distances.push_back(both.distance(i) / radius(Compared::id(a, i)));
        if (angles_known) angles.push_back(both.angle(i));
    }
    if (distances_known) d.distance = figures(distances);
    if (angles_known) d.normal_degrees = figures(angles);
    d.rmse = d.pixels ? std::sqrt(squares / (3.0 * double(d.pixels))) : 0;
    if (d.rmse > 0) d.psnr = -20 * std::log10(d.rmse);
    d.perceptual_fails = image_module().perceptual_fails(colors(a), colors(b));
    return d;
}

void write_difference(const std::string& path, const Film& a, const Film& b) {
    const auto kind = image_kind(path);
    if (!kind) throw WorkError(fmt::format("cannot write '{}': unknown image format", path));
    const bool bytes = *kind == ImageKind::display, exr = *kind == ImageKind::exr;
    const Compared both(a, b);
    ImageRaster image{a.width, a.height, a.window, {}, {}};
    const auto add = [&](const char* name, auto value) {
        image.channels.push_back(image_channel(name, bytes ? ChannelType::byte : ChannelType::single_float, value));
    };
    const auto add_color = [&](const char* name, int k) {
        add(name, [both, k, bytes](std::size_t i) {
            const double d = std::abs(both.color(i)[k]);
            return bytes ? std::round(255 * std::min(d, 1.0)) : d;
        });
    };
    add_color("R", 0);
    add_color("G", 1);
    add_color("B", 2);
    if (exr) {
        const auto same = [both](std::size_t i) { return both.hit(i) == 0 && both.first().pixels[i].alpha > 0; };
        if (both.both_keep(ImageLayer::position))
            add("distance", [=](std::size_t i) { return same(i) ? both.distance(i) : 0.0; });
        if (both.both_keep(ImageLayer::normal))
            add("angle", [=](std::size_t i) { return same(i) ? both.angle(i) : 0.0; });
        add("hit", [both](std::size_t i) { return double(both.hit(i)); });
    }
    write_raster(path, image);
}

// The value as the number of a solid; 0 if it cannot be one, since files may hold anything.
static std::uint32_t whole_number(float value) {
    return value >= 0 && value < 4294967296.0f ? std::uint32_t(value) : 0;
}

Film read_picture(const std::string& path) {
    const auto read = [&] {
        try {
            return image_module().read(path, read_picture_header(path));
        } catch (const UnsupportedError&) {
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            throw UsageError(fmt::format("cannot read picture '{}': {}", path, error.what()));
        }
    };
    const ReadImage image = read();
    const auto channel = [&](const char* name) {
        const auto at = std::find(image.channels.begin(), image.channels.end(), name);
        return at == image.channels.end() ? -1 : int(at - image.channels.begin());
    };
    const int rgb[3] = {std::max(0, channel("R")), channel("G"), channel("B")}, alpha = channel("A"),
              id = channel("id");
    const int position[3] = {channel("P.X"), channel("P.Y"), channel("P.Z")};
    const int normal[3] = {channel("N.X"), channel("N.Y"), channel("N.Z")};
    std::vector<ImageLayer> kept;
    // A layer that is incomplete in the file is ignored.
    const bool has_position = *std::min_element(position, position + 3) >= 0;
    const bool has_normal = *std::min_element(normal, normal + 3) >= 0;
    if (has_position) kept.push_back(ImageLayer::position);
    if (has_normal) kept.push_back(ImageLayer::normal);
    if (id >= 0) kept.push_back(ImageLayer::id);
    Film film(image.width, image.height, image.window, kept);
    const auto width = std::size_t(film.window.width);
    std::vector<PixelLayers> row(width);  // row by row, since all at once would take more memory than the film
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        PixelLayers& layers = row[i % width];
        const float* from = &image.values[i * image.channels.size()];
        Pixel& p = film.pixels[i];
        for (int k = 0; k < 3; ++k) {
            p.color[k] = from[rgb[k] >= 0 ? rgb[k] : rgb[0]];
            if (has_position) layers.position[k] = from[position[k]];
            if (has_normal) layers.normal[k] = from[normal[k]];
        }
        p.alpha = alpha >= 0 ? from[alpha] : 1;
        if (id >= 0) layers.id = whole_number(from[id]);
        if ((i + 1) % width == 0)
            film.set_layers({film.window.x, film.window.y + int(i / width), film.window.width, 1}, row.data());
    }
    return film;
}

}  // namespace deburr
