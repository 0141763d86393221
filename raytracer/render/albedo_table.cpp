#include "raytracer/render/albedo_table.hpp"

#include <numbers>
#include <vector>

#include "raytracer/render/bsdf.hpp"

namespace deburr {
namespace {

// Least cosine, since masking is 0/0 at a cosine of 0.
constexpr double min_table_cosine = 1e-5;

// Facets sampled for each entry of a table: a lattice of golden steps over half a turn, since the other half is its
// mirror image. With these, white tables of six roughnesses were within 3·10⁻⁴ of sums of 2²⁰ facets.
constexpr int facets = 4096;

const std::vector<Vec2>& half_turns() {
    static const std::vector<Vec2> all = [] {
        std::vector<Vec2> turns;
        for (int i = 0; i < facets; ++i) {
            const double phi = pi * (glm::fract((i + 0.5) / std::numbers::phi) - 0.5);
            turns.push_back({std::cos(phi), std::sin(phi)});
        }
        return turns;
    }();
    return all;
}

}  // namespace

AlbedoTable::AlbedoTable(Kind kind, double alpha, double ior) {
    for (int i = 0; i <= steps; ++i) albedo_[i] = integral(kind, alpha, ior, double(i) * i / (double(steps) * steps));
    // With cosine = t² and an albedo linear in t between entries, the mean is ∫ 4 albedo t³ dt, of degree 4 in each
    // step, for which Gauss' rule of three points is exact.
    constexpr double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double nodes[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < 3; ++k) {
            const double t = (i + nodes[k]) / steps;
            mean_ += weights[k] / steps * 4 * t * t * t * glm::mix(albedo_[i], albedo_[i + 1], nodes[k]);
        }
    if (mean_ < 1) base_share_ = std::numbers::inv_pi / (1 - mean_);
}

// The mean weight of reflection and transmission by visible facets.
double AlbedoTable::integral(Kind kind, double alpha, double ior, double cosine) const {
    const double c = std::max(cosine, min_table_cosine);
    if (!(alpha >= smooth_alpha)) return kind == Kind::boundary ? fresnel_dielectric(cosine, ior) : 1.0;
    const Ggx ggx{alpha};
    const Vec3 to_eye(0, -std::sqrt(std::max(0.0, 1 - c * c)), c), eye = ggx.stretched(to_eye);
    double sum = 0;
    for (int i = 0; i < facets; ++i) {
        const Vec3 facet = ggx.facet_about_z(eye, (i + 0.5) / facets, half_turns()[i]);
        const double share = kind == Kind::white ? 1.0 : fresnel_dielectric(glm::dot(to_eye, facet), ior);
        const double back = reflected(to_eye, facet).z;
        if (back > 0) sum += share * ggx.shadowing(back, c);
        Vec3 through;
        if (kind == Kind::both && share < 1 && refracted(to_eye, facet, ior, through) && through.z < 0)
            sum += (1 - share) * ggx.shadowing(-through.z, c);
    }
    return sum / facets;
}

double AlbedoTable::at(double cosine) const {
    const double t = std::sqrt(glm::clamp(cosine, 0.0, 1.0)) * steps;
    const int i = t < steps ? int(t) : steps - 1;  // the last one for NaN, too
    return glm::mix(albedo_[i], albedo_[i + 1], t - i);
}

}  // namespace deburr
