#include "raytracer/render/bsdf.hpp"

#include <numbers>
#include <vector>

namespace deburr {
namespace {

// Least cosine at a shading point, since G and E are 0/0 at 0.
constexpr double min_cosine = 1e-5;

struct Frame {
    Vec3 x, y, z;
    // [Duff et al., Building an Orthonormal Basis, Revisited, 2017]
    explicit Frame(Vec3 normal) : z(normal) {
        const double sign = std::copysign(1.0, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
        x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
        y = {b, sign + z.y * z.y * a, -z.y};
    }
    Vec3 to_world(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
    Vec3 to_local(Vec3 v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
};

// Coefficients of the series in a²: ±1 / (2k + 1)! and ±1 / (2k)!, the last one first.
constexpr double sine_terms[] = {-1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880,
                                 -1.0 / 5040,          1.0 / 120,        -1.0 / 6,        1};
constexpr double cosine_terms[] = {1.0 / 20922789888000,
                                   -1.0 / 87178291200,
                                   1.0 / 479001600,
                                   -1.0 / 3628800,
                                   1.0 / 40320,
                                   -1.0 / 720,
                                   1.0 / 24,
                                   -1.0 / 2,
                                   1};

// Cosine and sine of 2π u for u in [0, 1], to 2⁻⁵²: by their series up to π/4, in half the time of the library's
// functions.
Vec2 turn_by(double u) {
    const int quarter = int(4 * u + 0.5);
    const double a = (4 * u - quarter) * (pi / 2), s = a * a;
    double sine = 0, cosine = 0;
    for (const double c : sine_terms) sine = sine * s + c;
    for (const double c : cosine_terms) cosine = cosine * s + c;
    sine *= a;
    // By quarters, without a branch that could not be predicted.
    const double of[2] = {cosine, sine}, sign[4] = {1, -1, -1, 1};
    return {sign[quarter & 3] * of[quarter & 1], sign[(quarter + 3) & 3] * of[~quarter & 1]};
}

double power5(double x) { return x * x * x * x * x; }

}  // namespace

double fresnel_dielectric(double cosine, double ior) {
    const double c = glm::clamp(std::abs(cosine), 0.0, 1.0);
    const double g2 = ior * ior - 1 + c * c;  // (ior · cosine of the refracted ray)²
    if (g2 <= 0) return 1.0;
    const double g = std::sqrt(g2);
    // (c − g)/(c + g) and (ior² c − g)/(ior² c + g), by a single division.
    const double d = ior * ior * c, inverse = 1 / ((c + g) * (d + g));
    const double s = (c - g) * (d + g) * inverse, p = (d - g) * (c + g) * inverse;
    return 0.5 * (s * s + p * p);
}

Vec3 fresnel_schlick(Vec3 f0, double cosine) { return f0 + (1.0 - f0) * power5(1 - glm::clamp(cosine, 0.0, 1.0)); }

Vec3 reflected(Vec3 to_eye, Vec3 normal) { return 2 * glm::dot(to_eye, normal) * normal - to_eye; }

bool refracted(Vec3 to_eye, Vec3 normal, double ior, Vec3& direction) {
    const double c = glm::dot(to_eye, normal);
    const double g2 = ior * ior - 1 + c * c;
    if (g2 <= 0) return false;
    direction = glm::normalize(((c - std::sqrt(g2)) * normal - to_eye) / ior);
    return true;
}

Vec3 cosine_direction(Vec3 normal, Vec2 u) {
    return Frame(normal).to_world({std::sqrt(u.x) * turn_by(u.y), std::sqrt(std::max(0.0, 1 - u.x))});
}

double Ggx::distribution(double cos_half) const {
    const double d = cos_half * cos_half * (alpha * alpha - 1) + 1;
    return alpha * alpha / (pi * d * d);
}

double Ggx::shadowing(double cos_in, double cos_out) const {
    const double a2 = alpha * alpha;
    const double root_in = std::sqrt(a2 + (1 - a2) * cos_in * cos_in);
    const double root_out = std::sqrt(a2 + (1 - a2) * cos_out * cos_out);
    return cos_in * (cos_out + root_out) / (cos_out * root_in + cos_in * root_out);
}

double Ggx::density(double cos_out, double cos_half) const {
    const double a2 = alpha * alpha;
    return distribution(cos_half) / (2 * (cos_out + std::sqrt(a2 + (1 - a2) * cos_out * cos_out)));
}

Vec3 Ggx::facet(Vec3 to_eye, Vec3 normal, Vec2 u) const {
    const Frame frame(normal);
    return frame.to_world(facet_about_z(stretched(frame.to_local(to_eye)), u.x, turn_by(u.y)));
}

Material::Kind preview_kind(const Material& m) {
    if (m.kind != Material::Kind::pbr) return m.kind;
    if (m.metallic >= 0.5) return Material::Kind::metal;
    return m.transmission >= 0.5 ? Material::Kind::glass : Material::Kind::plastic;
}

bool SurfaceLayer::same(const Material& a, const Material& b) {
    return preview_kind(a) == preview_kind(b) && a.roughness == b.roughness && a.ior == b.ior;
}

SurfaceLayer::SurfaceLayer(const Material& material)
    : kind_(preview_kind(material)), ggx_{material.roughness * material.roughness}, ior_(material.ior) {
    smooth_ = kind_ == Material::Kind::mirror || !(ggx_.alpha >= smooth_alpha);
    if (kind_ == Material::Kind::glass) return;
    for (int i = 0; i <= steps; ++i) albedo_[i] = integrate(double(i) * i / (double(steps) * steps));
    // With cosine = t² and E linear in t between entries, 2 E cosine d cosine = 4 E t³ dt, which Gauss' rule of three
    // points integrates exactly.
    constexpr double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double nodes[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
    for (int i = 0; i < steps; ++i)
        for (int k = 0; k < 3; ++k) {
            const double t = (i + nodes[k]) / steps;
            mean_ += weights[k] / steps * 4 * t * t * t * albedo(t * t);
        }
    if (mean_ < 1) base_share_ = 1 / (pi * (1 - mean_));
}

// The mean weight of reflections by visible facets, over a lattice of golden steps. Over five roughnesses, two indices
// and five angles, a white furnace was off by at most 10⁻³.
double SurfaceLayer::integrate(double cosine) const {
    if (kind_ == Material::Kind::matte) return 0.0;
    const double c = std::max(cosine, min_cosine);
    if (smooth_) return kind_ == Material::Kind::plastic ? fresnel_dielectric(c, ior_) : 1.0;
    constexpr int points = 1024;
    static const std::vector<Vec2> turns = [] {
        std::vector<Vec2> all;
        for (int i = 0; i < points; ++i) all.push_back(turn_by(glm::fract((i + 0.5) / std::numbers::phi)));
        return all;
    }();
    const Vec3 to_eye(0, -std::sqrt(std::max(0.0, 1 - c * c)), c), eye = ggx_.stretched(to_eye);
    const bool plastic = kind_ == Material::Kind::plastic;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        const Vec3 facet = ggx_.facet_about_z(eye, (i + 0.5) / points, turns[i]);
        const double out = reflected(to_eye, facet).z;
        if (!(out > 0)) continue;
        // The Fresnel reflectance of white metal is 1.
        const double share = plastic ? fresnel_dielectric(glm::dot(to_eye, facet), ior_) : 1.0;
        sum += share * ggx_.shadowing(out, c);
    }
    return sum / points;
}

bool SurfaceLayer::polished() const {
    // Roughness 0.3. Beyond, a sharp reflection of objects would be more wrong than none.
    constexpr double polished_alpha = 0.09;
    if (kind_ == Material::Kind::matte) return false;
    return smooth_ || (kind_ == Material::Kind::metal && ggx_.alpha <= polished_alpha);
}

double SurfaceLayer::albedo(double cosine) const {
    const double at = std::sqrt(glm::clamp(cosine, 0.0, 1.0)) * steps;
    const auto i = at < steps ? std::size_t(at) : std::size_t(steps - 1);  // the last one for NaN, too
    return glm::mix(albedo_[i], albedo_[i + 1], at - double(i));
}

}  // namespace deburr
