#include "bounds/kept_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deburr {
namespace {

constexpr double end_potential = 8.0 / 15;    // φ₀
constexpr double least_turn = 0.86602540378;  // cosine of 30°
// For the kernel k(ρ) = (1 − ρ²/w²)²/w: the largest |k′| w², at ρ² = w²/3, and the largest |k″| w³, at ρ = w.
constexpr double steepest_kernel = 1.5397, most_bent_kernel = 8;

double smooth(double u) { return u * u * (3 - 2 * u); }
double smooth_slope(double u) { return 6 * u * (1 - u); }

// Adds φ and ∇φ of one edge.
void add_potential(const LocalRadius::Segment& e, Vec3 x, double w, double& potential, Vec3& gradient) {
    const Vec3 d = e.to - e.from;
    const double length = glm::length(d);
    if (!(length > 0)) return;
    const Vec3 along = d / length;
    const double foot = glm::dot(x - e.from, along);
    const Vec3 away = (x - e.from - foot * along) / w;
    const double q2 = 1 - glm::dot(away, away);  // square of half the chord in the ball of radius w, in units of w
    if (!(q2 > 0)) return;
    const double q = std::sqrt(q2);
    const double a = std::clamp(-foot / w, -q, q), b = std::clamp((length - foot) / w, -q, q);
    const auto integral = [&](double s) { return s * (q2 * q2 - s * s * (2.0 / 3 * q2 - s * s / 5)); };
    const auto across = [&](double s) { return s * (q2 - s * s / 3); };
    const auto kernel = [&](double s) { return (q2 - s * s) * (q2 - s * s); };
    potential += integral(b) - integral(a);
    gradient += (-4 * (across(b) - across(a)) * away + (kernel(a) - kernel(b)) * along) / w;
}

// Upper bound of the length of the edge's part that is within w of a box whose half diagonal is `half`.
double length_within(const LocalRadius::Segment& e, double w, double half) {
    return std::min(glm::distance(e.from, e.to), 2 * (w + half));
}

/// Distance of x from the region, and its gradient.
double distance(const Box& region, Vec3 x, Vec3& direction) {
    const Vec3 on = glm::clamp(x, region.lo, region.hi);
    const double d = glm::distance(x, on);
    direction = d > 0 ? (x - on) / d : Vec3(0.0);
    return d;
}

// Range of the distances of the box's points from the region.
Range distances(const Box& region, const Box& box) {
    Vec3 least(0.0), greatest(0.0);
    for (int k = 0; k < 3; ++k) {
        least[k] = std::max({0.0, region.lo[k] - box.hi[k], box.lo[k] - region.hi[k]});
        greatest[k] = std::max({0.0, region.lo[k] - box.lo[k], box.hi[k] - region.hi[k]});
    }
    return {glm::length(least), glm::length(greatest)};
}

// One factor S(u) of the radius over a box: its range, and upper bounds of |S′| and |S″|.
struct Factor {
    Range value;
    double rate, bend;
};

// The factor where u is in this range, |u′| ≤ rate and |u″| ≤ bend.
Factor factor(Range u, double rate, double bend) {
    u = {std::clamp(u.lo, 0.0, 1.0), std::clamp(u.hi, 0.0, 1.0)};
    if (u.hi <= 0 || u.lo >= 1) return {{smooth(u.lo), smooth(u.hi)}, 0, 0};
    const double slope = u.lo <= 0.5 && u.hi >= 0.5 ? 1.5 : std::max(smooth_slope(u.lo), smooth_slope(u.hi));
    constexpr double most_bent = 6;  // |S″|
    return {{smooth(u.lo), smooth(u.hi)}, slope * rate, most_bent * rate * rate + slope * bend};
}

}  // namespace

LocalRadius::LocalRadius(ClosedMeshPtr mesh, double radius, double least, KeptEdges kept)
    : mesh_(std::move(mesh)), radius_(radius), least_(least), kept_(std::move(kept)) {
    if (kept_.edges == KeptEdges::Kind::none) return;
    is_kept_.assign(mesh_->size(), 0);
    for (int t = 0; t < int(mesh_->size()); ++t)
        for (int k = 0; k < 3; ++k) {
            const ClosedMesh::Neighbour& other = mesh_->across(t, k);
            if (other.triangle < t || (other.triangle == t && other.edge < k)) continue;
            const ClosedMesh::Plane &a = mesh_->plane(t), &b = mesh_->plane(other.triangle);
            if (a.id == b.id || glm::dot(a.normal, b.normal) > least_turn) continue;
            const Vec3 along = mesh_->corner(t, (k + 1) % 3) - mesh_->corner(t, k);
            const bool convex = glm::dot(glm::cross(a.normal, b.normal), along) > 0;
            if (convex == (kept_.edges == KeptEdges::Kind::convex)) is_kept_[t] |= static_cast<unsigned char>(1 << k);
        }
}

void LocalRadius::near(const Box& box, std::vector<Segment>& found) const {
    if (is_kept_.empty()) return;
    thread_local std::vector<int> triangles;
    triangles.clear();
    mesh_->near(box, kept_.fade, triangles);
    for (const int t : triangles)
        for (int k = 0; k < 3; ++k)
            if ((is_kept_[t] >> k & 1) != 0) found.push_back({mesh_->corner(t, k), mesh_->corner(t, (k + 1) % 3)});
}

LocalRadius::Value LocalRadius::at(Vec3 x, std::span<const Segment> edges) const {
    const double w = kept_.fade;
    double product = 1;
    Vec3 relative(0.0);  // the gradient of the product
    const auto multiply = [&](double u, Vec3 slope) {
        if (u >= 1) return;
        u = std::max(u, 0.0);
        const double s = smooth(u);
        // The product rule in this form holds where a factor is 0, too.
        relative = relative * s + product * smooth_slope(u) * slope;
        product *= s;
    };
    for (const Box& region : kept_.regions) {
        Vec3 direction;
        const double d = distance(region, x, direction);
        multiply(d / w, direction / w);
    }
    if (!edges.empty()) {
        double potential = 0;
        Vec3 gradient(0.0);
        for (const Segment& e : edges) add_potential(e, x, w, potential, gradient);
        multiply(1 - potential / end_potential, gradient * (-1 / end_potential));
    }
    return {least_ + (radius_ - least_) * product, (radius_ - least_) * relative};
}

LocalRadius::Bounds LocalRadius::over(const Box& box, std::span<const Segment> edges) const {
    const double w = kept_.fade;
    std::vector<Factor> factors;
    for (const Box& region : kept_.regions) {
        const Range d = distances(region, box);
        if (d.lo >= w) continue;
        // The distance from a box has the second derivative 1/d beside an edge or corner of the box; S′ ≤ 6u = 6d/w
        // compensates for it.
        Factor f = factor({d.lo / w, d.hi / w}, 1 / w, 0);
        const bool bends = d.hi > 0;
        constexpr double of_corners = 6;
        if (bends) f.bend += of_corners / (w * w);
        factors.push_back(f);
    }
    if (!edges.empty()) {
        const Vec3 center = 0.5 * (box.lo + box.hi);
        const double half = 0.5 * glm::distance(box.lo, box.hi);
        double potential = 0, length = 0;
        Vec3 gradient(0.0);
        for (const Segment& e : edges) {
            const double away = distance_to_segment(center, e.from, e.to);
            if (away >= w + half) continue;
            length += length_within(e, w, half);
            add_potential(e, center, w, potential, gradient);
        }
        if (length > 0) {
            const double bend = most_bent_kernel * length / (w * w * w);
            const double rate = std::min(steepest_kernel * length / (w * w), glm::length(gradient) + bend * half);
            const double off = std::min(rate * half, glm::length(gradient) * half + 0.5 * bend * half * half);
            const double u = 1 - potential / end_potential, du = off / end_potential;
            factors.push_back(factor({u - du, u + du}, rate / end_potential, bend / end_potential));
        }
    }
    Bounds bounds{{radius_, radius_}};
    double least = 1, greatest = 1, rate = 0, bend = 0;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        double others = 1;
        for (std::size_t k = 0; k < factors.size(); ++k)
            if (k != i) others *= factors[k].value.hi;
        least *= factors[i].value.lo;
        greatest *= factors[i].value.hi;
        rate += factors[i].rate * others;
        bend += factors[i].bend * others;
        for (std::size_t k = 0; k < i; ++k) bend += 2 * factors[i].rate * factors[k].rate;
    }
    if (least >= 1) return bounds;
    const double span = radius_ - least_;
    bounds.radius = {least_ + span * least, least_ + span * greatest};
    bounds.rate = greatest > 0 ? span * rate : 0;
    bounds.bend = greatest > 0 ? span * bend : 0;
    return bounds;
}

}  // namespace deburr
