#include "raytracer/image/view_transform.hpp"

namespace deburr {
namespace {

// AgX in its common short form of Sobotka's configuration: the primaries are moved towards grey, then a logarithm over
// 16½ stops, a polynomial for the curve, and the primaries moved back. Matrices are given by columns.
const Mat3 inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051,  //
                 0.0784335999999992, 0.878468636469772, 0.0784336,           //
                 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
constexpr double lowest_stop = -12.47393, highest_stop = 4.026069;
constexpr double display_gamma = 2.2;

double curve(double x) {
    const double x2 = x * x, x4 = x2 * x2;
    return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
}

}  // namespace

Vec3 displayed(ViewTransform view, Vec3 light) {
    if (view == ViewTransform::standard) return light;
    Vec3 v = inset * glm::max(light, Vec3(0.0));
    for (int k = 0; k < 3; ++k) {
        const double stops = v[k] > 0 ? std::log2(v[k]) : lowest_stop;
        v[k] = curve(glm::clamp((stops - lowest_stop) / (highest_stop - lowest_stop), 0.0, 1.0));
    }
    static const Mat3 outset = glm::inverse(inset);
    return glm::pow(glm::clamp(outset * v, Vec3(0.0), Vec3(1.0)), Vec3(display_gamma));
}

Film displayed(ViewTransform view, Film film, bool alpha) {
    if (view == ViewTransform::standard) return film;
    for (Pixel& p : film.pixels) {
        if (!alpha)
            p.color = displayed(view, p.color);
        else if (p.alpha > 0)
            p.color = displayed(view, p.color / p.alpha) * p.alpha;
    }
    return film;
}

}  // namespace deburr
