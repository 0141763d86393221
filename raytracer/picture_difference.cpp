#include "raytracer/picture_difference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "raytracer/errors.hpp"
#include "raytracer/image_file.hpp"
#include "raytracer/image_module.hpp"

namespace deburr {
namespace {

constexpr double degrees = 57.29577951308232;

DifferenceFigures figures(std::vector<double>& values) {
    DifferenceFigures f;
    if (values.empty()) return f;
    std::sort(values.begin(), values.end());
    for (const double v : values) f.mean += v / double(values.size());
    f.p99 = values[std::min(values.size() - 1, std::size_t(0.99 * double(values.size())))];
    f.max = values.back();
    return f;
}

double angle(Vec3 a, Vec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * degrees;
}

ReadImage colors(const Film& film) {
    ReadImage image{film.width, film.height, film.window, {"R", "G", "B"}, {}};
    for (const Pixel& p : film.pixels)
        for (int k = 0; k < 3; ++k) image.values.push_back(float(p.color[k]));
    return image;
}

int hit_class(const Pixel& a, const Pixel& b) {
    if (a.alpha > 0 && !(b.alpha > 0)) return 1;
    if (b.alpha > 0 && !(a.alpha > 0)) return 2;
    return a.id != b.id ? 3 : 0;
}

}  // namespace

PictureDifference difference(const Picture& a, const Picture& b, const std::vector<double>& radii) {
    PictureDifference d;
    d.pixels = a.film.pixels.size();
    d.in_radii = !radii.empty();
    double least = infinity;
    for (const double r : radii)
        if (r > 0) least = std::min(least, r);
    if (!(least < infinity)) d.in_radii = false;
    const auto radius = [&](std::uint32_t id) {
        if (!d.in_radii) return 1.0;
        return id >= 1 && id <= radii.size() && radii[id - 1] > 0 ? radii[id - 1] : least;
    };
    const auto counts = [&](const Pixel& p) {
        return p.alpha > 0 && (!d.in_radii || (p.id >= 1 && p.id <= radii.size() && radii[p.id - 1] > 0));
    };
    std::vector<double> distances, angles;
    double squares = 0;
    for (std::size_t i = 0; i < d.pixels; ++i) {
        const Pixel &p = a.film.pixels[i], &q = b.film.pixels[i];
        const Vec3 c = p.color - q.color;
        squares += glm::dot(c, c);
        if (!counts(p) && !counts(q)) continue;
        ++d.on_object;
        const int hit = hit_class(p, q);
        d.only_first += hit == 1;
        d.only_second += hit == 2;
        d.other_solid += hit == 3;
        if (hit != 0) continue;
        distances.push_back(glm::length(p.position - q.position) / radius(p.id));
        angles.push_back(angle(p.normal, q.normal));
    }
    if (a.has_position && b.has_position) d.distance = figures(distances);
    if (a.has_normal && b.has_normal) d.normal_degrees = figures(angles);
    d.rmse = d.pixels ? std::sqrt(squares / (3.0 * double(d.pixels))) : 0;
    if (d.rmse > 0) d.psnr = -20 * std::log10(d.rmse);
    d.perceptual_fails = image_module().perceptual_fails(colors(a.film), colors(b.film));
    return d;
}

void write_difference(const std::string& path, const Picture& a, const Picture& b) {
    const auto kind = image_kind(path);
    if (!kind) throw WorkError(fmt::format("cannot write '{}': unknown image format", path));
    const bool bytes = *kind == ImageKind::display, exr = *kind == ImageKind::exr;
    const auto& first = a.film.pixels;
    const auto& second = b.film.pixels;
    ImageRaster image{a.film.width, a.film.height, a.film.window, {}, {}};
    const auto add = [&](const char* name, auto value) {
        image.channels.push_back(image_channel(name, bytes ? ChannelType::byte : ChannelType::single_float,
                                               [&, value](std::size_t i) { return value(first[i], second[i]); }));
    };
    const auto add_color = [&](const char* name, int k) {
        add(name, [k, bytes](const Pixel& p, const Pixel& q) {
            const double d = std::abs(p.color[k] - q.color[k]);
            return bytes ? std::round(255 * std::min(d, 1.0)) : d;
        });
    };
    add_color("R", 0);
    add_color("G", 1);
    add_color("B", 2);
    if (exr) {
        const auto both = [](const Pixel& p, const Pixel& q) { return hit_class(p, q) == 0 && p.alpha > 0; };
        add("distance", [=](const Pixel& p, const Pixel& q) { return both(p, q) ? glm::length(p.position - q.position) : 0; });
        add("angle", [=](const Pixel& p, const Pixel& q) { return both(p, q) ? angle(p.normal, q.normal) : 0; });
        add("hit", [](const Pixel& p, const Pixel& q) { return double(hit_class(p, q)); });
    }
    write_raster(path, image);
}

Picture read_picture(const std::string& path) {
    const auto read = [&] {
        try {
            return image_module().read(path);
        } catch (const UnsupportedError&) {
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
    const int rgb[3] = {std::max(0, channel("R")), channel("G"), channel("B")}, alpha = channel("A"), id = channel("id");
    const int position[3] = {channel("P.X"), channel("P.Y"), channel("P.Z")};
    const int normal[3] = {channel("N.X"), channel("N.Y"), channel("N.Z")};
    Picture picture{Film(image.width, image.height, image.window), position[0] >= 0, normal[0] >= 0};
    for (std::size_t i = 0; i < picture.film.pixels.size(); ++i) {
        const float* from = &image.values[i * image.channels.size()];
        Pixel& p = picture.film.pixels[i];
        for (int k = 0; k < 3; ++k) {
            p.color[k] = from[rgb[k] >= 0 ? rgb[k] : rgb[0]];
            if (picture.has_position) p.position[k] = from[position[k]];
            if (picture.has_normal) p.normal[k] = from[normal[k]];
        }
        p.alpha = alpha >= 0 ? from[alpha] : 1;
        if (id >= 0) p.id = std::uint32_t(from[id]);
    }
    return picture;
}

}  // namespace deburr
