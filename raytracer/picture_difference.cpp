#include "raytracer/picture_difference.hpp"

#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

#include "raytracer/errors.hpp"
#include "raytracer/image_format.hpp"

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

OIIO::ImageBuf colors(const Film& film) {
    std::vector<float> data;
    for (const Pixel& p : film.pixels)
        for (int k = 0; k < 3; ++k) data.push_back(float(p.color[k]));
    OIIO::ImageBuf image(OIIO::ImageSpec(film.window.width, film.window.height, 3, OIIO::TypeDesc::FLOAT));
    image.set_pixels(OIIO::ROI(0, film.window.width, 0, film.window.height, 0, 1, 0, 3), OIIO::TypeDesc::FLOAT,
                     data.data());
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
    OIIO::ImageBufAlgo::CompareResults yee;
    d.perceptual_fails = OIIO::ImageBufAlgo::compare_Yee(colors(a.film), colors(b.film), yee);
    return d;
}

void write_difference(const std::string& path, const Picture& a, const Picture& b) {
    const Window w = a.film.window;
    const bool exr = image_kind(path) == ImageKind::exr;
    const int channels = exr ? 6 : 3;
    std::vector<float> data;
    for (std::size_t i = 0; i < a.film.pixels.size(); ++i) {
        const Pixel &p = a.film.pixels[i], &q = b.film.pixels[i];
        for (int k = 0; k < 3; ++k) data.push_back(float(std::abs(p.color[k] - q.color[k])));
        if (!exr) continue;
        const int hit = hit_class(p, q);
        const bool both = hit == 0 && p.alpha > 0;
        data.push_back(float(both ? glm::length(p.position - q.position) : 0));
        data.push_back(float(both ? angle(p.normal, q.normal) : 0));
        data.push_back(float(hit));
    }
    OIIO::ImageSpec spec(w.width, w.height, channels, exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    if (exr) spec.channelnames = {"R", "G", "B", "distance", "angle", "hit"};
    const auto out = OIIO::ImageOutput::create(path);
    if (!out || !out->open(path, spec) || !out->write_image(OIIO::TypeDesc::FLOAT, data.data()) || !out->close())
        throw WorkError(fmt::format("cannot write '{}': {}", path, out ? out->geterror() : OIIO::geterror()));
}

Picture read_picture(const std::string& path) {
    const auto in = OIIO::ImageInput::open(path);
    if (!in) throw UsageError(fmt::format("cannot read picture '{}': {}", path, OIIO::geterror()));
    const OIIO::ImageSpec spec = in->spec();
    std::vector<float> data(spec.image_pixels() * std::size_t(spec.nchannels));
    if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, data.data()))
        throw UsageError(fmt::format("cannot read picture '{}': {}", path, in->geterror()));
    const auto channel = [&](const char* name) { return spec.channelindex(name); };
    const int rgb[3] = {std::max(0, channel("R")), channel("G"), channel("B")}, alpha = channel("A"), id = channel("id");
    const int position[3] = {channel("P.X"), channel("P.Y"), channel("P.Z")};
    const int normal[3] = {channel("N.X"), channel("N.Y"), channel("N.Z")};
    Picture picture{Film(spec.full_width, spec.full_height, {spec.x - spec.full_x, spec.y - spec.full_y, spec.width, spec.height}),
                    position[0] >= 0, normal[0] >= 0};
    for (std::size_t i = 0; i < picture.film.pixels.size(); ++i) {
        const float* from = &data[i * std::size_t(spec.nchannels)];
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
