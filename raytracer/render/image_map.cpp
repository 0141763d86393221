#include "raytracer/render/image_map.hpp"

namespace deburr {
namespace {

// A position in a repeating row of pixels: the pixel to its left, the next one, and the position between their centers
// from 0 to 1.
struct Between {
    int left, right;
    double part;
};

Between between(double at, int count) {
    const double turns = at / count;
    const double x = (turns - std::floor(turns)) * count - 0.5, left = std::floor(x);
    const int i = (int(left) + count) % count;
    return {i, (i + 1) % count, x - left};
}

// The image's value at a position in widths of the image.
Vec3 value_of(const PictureData& picture, double right, double up) {
    if (!std::isfinite(right + up)) return Vec3(0.0);
    const Between x = between(right * picture.width, picture.width);
    const Between y = between(-up * picture.width, picture.height);
    const auto pixel = [&](int column, int row) {
        const float* rgb = &picture.rgb[3 * (std::size_t(row) * picture.width + column)];
        return Vec3(rgb[0], rgb[1], rgb[2]);
    };
    return glm::mix(glm::mix(pixel(x.left, y.left), pixel(x.right, y.left), x.part),
                    glm::mix(pixel(x.left, y.right), pixel(x.right, y.right), x.part), y.part);
}

// The weights of the projections along the three axes, whose sum is 1.
Vec3 shares(Vec3 normal, double blend) {
    const Vec3 size = glm::abs(normal);
    const double largest = max_component(size);
    if (!(largest > 0)) return {1, 0, 0};
    const Vec3 share = glm::max(size / largest - (1 - blend), Vec3(0.0));
    const double sum = share.x + share.y + share.z;
    if (sum > 0) return share / sum;
    if (size.x == largest) return {1, 0, 0};
    return size.y == largest ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
}

}  // namespace

Vec3 image_color(const Texture& t, Vec3 position, Vec3 normal) {
    if (!t.data) return t.a;
    const auto y_up = [&](Vec3 v) { return t.z_up ? Vec3(v.x, v.z, -v.y) : v; };
    const Vec3 p = y_up(position - t.origin) / t.scale, n = y_up(normal);
    const double angle = t.rotate * pi / 180, cosine = std::cos(angle), sine = std::sin(angle);
    const auto at = [&](double right, double up) {
        return value_of(*t.data, cosine * right + sine * up, cosine * up - sine * right);
    };
    const auto side = [](double component) { return component < 0 ? -1.0 : 1.0; };
    const Vec3 share = shares(n, t.blend);
    Vec3 sum(0.0);
    if (share.x > 0) sum += share.x * at(-side(n.x) * p.z, p.y);
    if (share.y > 0) sum += share.y * at(p.x, -side(n.y) * p.z);
    if (share.z > 0) sum += share.z * at(side(n.z) * p.x, p.y);
    return sum;
}

}  // namespace deburr
