#include "bounds/mesh_field.hpp"

#include <algorithm>
#include <utility>

#include "bounds/mesh_convolution.hpp"
#include "bounds/mesh_steepness.hpp"

namespace deburr {
namespace {

constexpr double steepest = 0.75;  // the greatest change of a share per radius of movement

// Calls visit(triangle, steepness) with bounds that hold for balls whose centres are within the box center ± half, and
// within `reach` radii of the center across the directions along which nothing changes.
template <class Visit>
void each_steepness(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 center, double r, Vec3 half,
                    double reach, Visit visit) {
    const double away = glm::length(half);
    for (const int t : triangles) {
        const ClosedMesh::Plane& plane = mesh.plane(t);
        const double h = std::abs(plane.offset - glm::dot(plane.normal, center)) / r;
        const ClosedMesh::Ball& ball = mesh.ball(t);
        const double farthest = (glm::distance(center, ball.center) + ball.radius + away) / r;
        visit(t, steepness(0, mesh.perimeter(t) / r, std::max(0.0, h - reach), h + reach, farthest >= 1));
    }
}

// A unit vector perpendicular to the normals of all these triangles; 0 if they are all parallel, none if there is no
// such direction.
std::optional<Vec3> swept_direction(const ClosedMesh& mesh, std::span<const int> triangles) {
    constexpr double same_direction = 1e-9;  // sine of the angle between normals
    const Vec3 first = mesh.plane(triangles[0]).normal;
    Vec3 sweep(0.0);
    for (const int t : triangles) {
        const Vec3 n = mesh.plane(t).normal;
        if (sweep == Vec3(0.0)) {
            const Vec3 common = glm::cross(first, n);
            const double sine = glm::length(common);
            if (sine > same_direction) sweep = common / sine;
        } else if (std::abs(glm::dot(sweep, n)) > same_direction) {
            return std::nullopt;
        }
    }
    return sweep;
}

// Half the extent of the box center ± half across the direction that all planes have in common, if there is one,
// because along it the share does not change; in world distances.
double reach_across(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 half) {
    const std::optional<Vec3> sweep = swept_direction(mesh, triangles);
    if (!sweep) return glm::length(half);
    if (*sweep == Vec3(0.0)) return glm::dot(glm::abs(mesh.plane(triangles[0]).normal), half);
    double square = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const Vec3 d(half.x, (corner & 1) != 0 ? -half.y : half.y, (corner & 2) != 0 ? -half.z : half.z);
        square = std::max(square, glm::dot(d, d) - glm::dot(d, *sweep) * glm::dot(d, *sweep));
    }
    return std::sqrt(square);
}

// Calls visit(normal, least, greatest) with the range of a face's |D|, in squared radii, for balls whose centres are
// within `reach` radii of x: such a ball holds one around x that is smaller by this, and lies in one that is larger.
template <class Visit>
void each_area_range(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r, double reach,
                     Visit visit) {
    thread_local std::vector<FaceAreas> faces;
    face_areas(mesh, triangles, x, (1 - reach) * r, (1 + reach) * r, faces);
    for (const FaceAreas& f : faces)
        visit(mesh.plane(f.triangle).normal, f.in_least / (r * r), std::min(f.in_greatest / (r * r), pi));
}

}  // namespace

MeshField::MeshField(ClosedMeshPtr mesh, double radius)
    : mesh_(std::move(mesh)), radius_(radius), sharp_(radius == 0), box_(mesh_->bounding_box()) {
    const double size = box_.empty() ? 1 : largest(box_.hi - box_.lo);
    if (sharp_) radius_ = sharp_radius * size;
}

MeshField::MeshField(Part, const MeshField& of, std::vector<int> triangles)
    : mesh_(of.mesh_),
      radius_(of.radius_),
      sharp_(of.sharp_),
      whole_(false),
      triangles_(std::move(triangles)),
      box_(of.box_) {}

// The part of an infinite cell beyond which no triangle reaches.
Box MeshField::reached(const Box& box) const { return intersection(box, inflated(box_, 2 * radius_)); }

/// The triangles that reach the cell, in increasing order; the span is valid as long as `memory` is unchanged.
std::span<const int> MeshField::near(const Box& cell, std::vector<int>& memory) const {
    memory.clear();
    const Box box = reached(cell);
    if (box.empty()) return memory;
    if (whole_) {
        mesh_->near(box, radius_, memory);
    } else {
        for (const int t : triangles_)
            if (mesh_->reaches(t, box, radius_)) memory.push_back(t);
    }
    return memory;
}

// Whether x is inside; for points that no triangle is near.
bool MeshField::is_inside(Vec3 x) const { return box_.contains(x) && mesh_->contains(x); }

ValueGradient MeshField::at(Vec3 x) const {
    thread_local std::vector<int> memory;
    std::span<const int> found = triangles_;
    if (whole_) {
        found = near({x, x}, memory);
        if (found.empty()) return {is_inside(x) ? 0.5 : -0.5};
    }
    ValueGradient v = ball_share(*mesh_, found, x, radius_);
    v.value -= 0.5;
    return v;
}

Range MeshField::range(const Box& box) const {
    thread_local std::vector<int> memory;
    return range(box, near(box, memory));
}

Range MeshField::range(const Box& box, std::span<const int> triangles) const {
    const Box seen = intersection(box, inflated(box_, radius_));
    if (seen.empty()) return {-0.5, -0.5};
    const Vec3 center = 0.5 * (seen.lo + seen.hi), half = 0.5 * (seen.hi - seen.lo);
    if (triangles.empty()) {
        const double f = is_inside(center) ? 0.5 : -0.5;
        return seen.lo == box.lo && seen.hi == box.hi ? Range{f, f} : Range{-0.5, f};
    }
    const double reach = reach_across(*mesh_, triangles, half) / radius_;
    if (steepest * reach > 1) return {-0.5, 0.5};
    const ValueGradient v = ball_share(*mesh_, triangles, center, radius_);
    double off = steepest * reach, curvature = 0;
    each_steepness(*mesh_, triangles, center, radius_, half, reach, [&](int, const Steepness& s) {
        curvature += 0.5 * (s.across + std::sqrt(s.across * s.across + s.along * s.along));
    });
    curvature *= 3 / (4 * pi);
    off = std::min(off, glm::dot(glm::abs(v.gradient), half) + 0.5 * curvature * reach * reach);
    if (reach < 1) {
        Vec3 lo(0.0), hi(0.0);  // range of Σ n |D|
        each_area_range(*mesh_, triangles, center, radius_, reach, [&](Vec3 n, double least, double greatest) {
            lo += glm::min(n * least, n * greatest);
            hi += glm::max(n * least, n * greatest);
        });
        off = std::min(off, 3 / (4 * pi * radius_) * glm::dot(glm::max(glm::abs(lo), glm::abs(hi)), half));
    }
    off += 64 * epsilon;
    return {std::max(-0.5, v.value - 0.5 - off), std::min(0.5, v.value - 0.5 + off)};
}

Range MeshField::rate_range(const Box& box, Vec3 direction) const {
    thread_local std::vector<int> memory;
    const std::span<const int> found = near(box, memory);
    if (found.empty()) return {0, 0};
    // Where no triangle faces against the direction the share does not grow along it, whatever the ball holds of them.
    Range cosine{infinity, -infinity};
    for (const int t : found) {
        const double along = glm::dot(mesh_->plane(t).normal, direction);
        cosine = {std::min(cosine.lo, along), std::max(cosine.hi, along)};
    }
    if (cosine.lo >= 0) return {-steepest / radius_, 0};
    if (cosine.hi <= 0) return {0, steepest / radius_};
    const Vec3 center = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    const double reach = reach_across(*mesh_, found, half) / radius_;
    const double rate = glm::dot(ball_share(*mesh_, found, center, radius_).gradient, direction);
    double curvature = 0;
    each_steepness(*mesh_, found, center, radius_, half, reach, [&](int t, const Steepness& s) {
        // d(∇f·n)/dx = Σ (n·N) ∇|D|, and |∇|D|| ≤ |h| φ + the length of the arcs' sum.
        curvature += std::abs(glm::dot(mesh_->plane(t).normal, direction)) * std::hypot(s.across, s.along);
    });
    const double off = curvature * (3 / (4 * pi)) * reach / radius_;
    Range rates{rate - off, rate + off};
    if (reach < 1) {
        Range sum;  // range of Σ n·direction |D|
        each_area_range(*mesh_, found, center, radius_, reach, [&](Vec3 n, double least, double greatest) {
            const double along = glm::dot(n, direction);
            sum.lo += std::min(along * least, along * greatest);
            sum.hi += std::max(along * least, along * greatest);
        });
        const double unit = 3 / (4 * pi * radius_), slack = 1e-12 * unit;
        rates = {std::max(rates.lo, -unit * sum.hi - slack), std::min(rates.hi, -unit * sum.lo + slack)};
    }
    return rates;
}

std::optional<Vec3> MeshField::swept_along() const {
    if (whole_ || triangles_.empty()) return std::nullopt;
    const std::optional<Vec3> sweep = swept_direction(*mesh_, triangles_);
    return sweep == Vec3(0.0) ? std::nullopt : sweep;
}

FieldPtr MeshField::prune(const Box& box) const {
    std::vector<int> found;
    near(box, found);
    if (found.empty() || (!whole_ && found.size() == triangles_.size())) return nullptr;
    found.shrink_to_fit();
    return FieldPtr(new MeshField(Part{}, *this, std::move(found)));
}

std::vector<HalfSpace> MeshField::planes() const {
    constexpr std::size_t few = 32;
    std::vector<HalfSpace> found;
    std::vector<int> ids;
    const auto add = [&](int t) {
        const ClosedMesh::Plane& plane = mesh_->plane(t);
        if (std::find(ids.begin(), ids.end(), plane.id) != ids.end()) return;
        ids.push_back(plane.id);
        found.push_back({plane.normal, plane.offset, radius_});
    };
    const std::size_t count = triangle_count();
    for (std::size_t i = 0; i < count && found.size() < few; ++i) add(whole_ ? int(i) : triangles_[i]);
    return found;
}

int MeshField::size() const {
    // The cost of a triangle in half-spaces.
    constexpr double triangle = 2;
    return int(std::min(1e9, std::max(1.0, triangle * double(triangle_count()))));
}

LocalSize MeshField::local_size(const Box& box) const {
    // A large box that many triangles reach gets the trivial range: looking at each triangle would hardly prove more.
    constexpr std::size_t many = 256;
    constexpr double large = 4;  // shortest side in radii
    const Box seen = reached(box);
    const Vec3 sides = seen.hi - seen.lo;
    if (min_component(sides) > large * radius_) {
        const std::size_t count = mesh_->count_near(seen, radius_);
        if (count > many) return {{-0.5, 0.5}, int(std::min<std::size_t>(count, 500'000'000) * 2)};
    }
    thread_local std::vector<int> memory;
    const std::span<const int> found = near(box, memory);
    return {range(box, found), std::max(1, 2 * int(found.size()))};
}

double MeshField::last_sign_change_bound(Vec3 origin, Vec3 direction) const {
    return leaves_box(inflated(box_, radius_), origin, direction);
}

void MeshField::begin_ray(FieldRay& ray) const {
    ray.noise_scale = share_noise_scale;
    ray.numbers.clear();
    const Vec3 a = ray.origin + ray.t0 * ray.direction, b = ray.origin + ray.t1 * ray.direction;
    const auto add = [&](int t) {
        const ClosedMesh::Ball& ball = mesh_->ball(t);
        if (distance_to_segment(ball.center, a, b) <= (ball.radius + radius_) * (1 + 16 * epsilon))
            ray.numbers.push_back(t);
    };
    if (whole_) {
        thread_local std::vector<int> memory;
        const Box along{glm::min(a, b), glm::max(a, b)};
        memory.clear();
        mesh_->near(along, radius_, memory);
        for (const int t : memory) add(t);
    } else {
        for (const int t : triangles_) add(t);
    }
}

ValueSlope MeshField::at(const FieldRay& ray, double t) const {
    thread_local std::vector<int> triangles;
    triangles.clear();
    const Vec3 x = ray.origin + t * ray.direction;
    for (const double number : ray.numbers) {
        const ClosedMesh::Ball& ball = mesh_->ball(int(number));
        const Vec3 away = x - ball.center;
        const double reach = ball.radius + radius_;
        if (glm::dot(away, away) <= reach * reach) triangles.push_back(int(number));
    }
    if (triangles.empty()) return {(is_inside(x) ? 0.5 : -0.5) / share_noise_scale, 0};
    const ValueGradient v = ball_share(*mesh_, triangles, x, radius_);
    return {(v.value - 0.5) / share_noise_scale, glm::dot(v.gradient, ray.direction) / share_noise_scale};
}

RayBounds MeshField::bounds(const FieldRay& ray, double t0, double t1) const {
    const double speed = glm::length(ray.direction);
    const Vec3 a = ray.origin + t0 * ray.direction, b = ray.origin + t1 * ray.direction, u = ray.direction / speed;
    double slope = 0, curvature = 0;
    for (const double number : ray.numbers) {
        const int t = int(number);
        const ClosedMesh::Ball& ball = mesh_->ball(t);
        if (distance_to_segment(ball.center, a, b) >= ball.radius + radius_) continue;
        const double farthest = std::max(glm::distance(ball.center, a), glm::distance(ball.center, b)) + ball.radius;
        const ClosedMesh::Plane& plane = mesh_->plane(t);
        const double ha = (plane.offset - glm::dot(plane.normal, a)) / radius_,
                     hb = (plane.offset - glm::dot(plane.normal, b)) / radius_;
        const double greatest = std::max(std::abs(ha), std::abs(hb));
        const double least = ha * hb <= 0 ? 0 : std::min(std::abs(ha), std::abs(hb));
        const Steepness s = steepness(mesh_->area(t) / (radius_ * radius_), mesh_->perimeter(t) / radius_, least,
                                      greatest, farthest >= radius_);
        const double along = std::abs(glm::dot(plane.normal, u)), across = std::sqrt(std::max(0.0, 1 - along * along));
        slope += along * s.area;
        curvature += along * (along * s.across + across * s.along);
    }
    const double unit = 3 / (4 * pi) / share_noise_scale;
    const double rate = speed / radius_;
    return {0.5 / share_noise_scale, unit * std::min(slope, pi) * rate, unit * curvature * rate * rate};
}

}  // namespace deburr
