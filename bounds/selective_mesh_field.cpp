#include "bounds/selective_mesh_field.hpp"

#include <algorithm>
#include <utility>

#include "bounds/mesh_convolution.hpp"
#include "bounds/mesh_steepness.hpp"

namespace deburr {
namespace {

constexpr double kept_radius = 0x1p-10;  // m, relative to the full radius
constexpr double unit = 3 / (4 * pi);

// Bounds of one triangle's sums in radii, for all radii in a range and centres whose signed distances from the
// triangle's plane are in a range. `farthest` is the greatest distance of a point of the triangle from a centre.
Steepness steepness_of(const ClosedMesh& mesh, int t, Range radius, Range distance, double farthest) {
    const double least =
        distance.lo <= 0 && distance.hi >= 0 ? 0 : std::min(std::abs(distance.lo), std::abs(distance.hi));
    const double greatest = std::max(std::abs(distance.lo), std::abs(distance.hi));
    return steepness(mesh.area(t) / (radius.lo * radius.lo), mesh.perimeter(t) / radius.lo, least / radius.hi,
                     greatest / radius.lo, farthest >= radius.lo);
}

// The largest |ηᵢ|.
double height(Range radius, Range distance) {
    return std::min(1.0, std::max(std::abs(distance.lo), std::abs(distance.hi)) / radius.lo);
}

// Sums for bounds of |f′| and |f″| in a direction that makes angles with the triangles' normals.
struct Rates {
    double slope = 0, swell = 0, bend = 0;

    /// Adds a triangle. `along` and `across` are the absolute cosine and sine of the angle between its normal and the
    /// direction, `rate` bounds |r′|.
    void add(const Steepness& s, double eta, double along, double across, double rate) {
        slope += along * s.area;
        swell += eta * s.area;
        bend += along * (along * s.across + across * s.along) + 2 * along * rate * std::max(3 * s.area, s.arcs) +
                rate * rate * eta * std::max(4 * s.area, s.arcs);
    }
    double first(double radius, double rate) const { return unit / radius * (std::min(slope, pi) + rate * swell); }
    double second(double radius, double r_bend) const { return unit / radius * (bend / radius + r_bend * swell); }
};

}  // namespace

// The triangles and kept edges that reach a finite box, and bounds of the radius there.
struct SelectiveMeshField::Local {
    std::vector<int> triangles;
    std::vector<LocalRadius::Segment> edges;
    LocalRadius::Bounds radius;
    Vec3 center{0.0};
};

SelectiveMeshField::SelectiveMeshField(ClosedMeshPtr mesh, double radius, KeptEdges kept)
    : mesh_(std::move(mesh)),
      radius_(std::make_shared<LocalRadius>(mesh_, radius, kept_radius * radius, std::move(kept))),
      full_(std::make_shared<MeshField>(mesh_, radius)),
      kept_(std::make_shared<MeshField>(mesh_, kept_radius * radius)) {}

SelectiveMeshField::SelectiveMeshField(Part, const SelectiveMeshField& of, const Local& local)
    : mesh_(of.mesh_),
      radius_(of.radius_),
      full_(of.full_),
      kept_(of.kept_),
      greatest_(local.radius.radius.hi),
      center_(local.center),
      whole_(false),
      triangles_(local.triangles),
      edges_(local.edges) {}

// The part of an infinite cell beyond which no triangle reaches.
Box SelectiveMeshField::reached(const Box& box) const {
    return intersection(box, inflated(mesh_->bounding_box(), 2 * radius_->full()));
}

SelectiveMeshField::Local SelectiveMeshField::local(const Box& box) const {
    Local l;
    l.center = 0.5 * (box.lo + box.hi);
    if (whole_) {
        radius_->near(box, l.edges);
    } else {
        const double reach = radius_->fade() + 0.5 * glm::distance(box.lo, box.hi);
        for (const LocalRadius::Segment& e : edges_)
            if (distance_to_segment(l.center, e.from, e.to) <= reach) l.edges.push_back(e);
    }
    l.radius = radius_->over(box, l.edges);
    if (whole_) {
        mesh_->near(box, l.radius.radius.hi, l.triangles);
    } else {
        for (const int t : triangles_)
            if (mesh_->reaches(t, box, l.radius.radius.hi)) l.triangles.push_back(t);
    }
    return l;
}

std::shared_ptr<const MeshField> SelectiveMeshField::constant(const LocalRadius::Bounds& bounds) const {
    if (bounds.radius.lo >= radius_->full()) return full_;
    if (bounds.radius.hi <= radius_->least()) return kept_;
    return nullptr;
}

ValueGradient SelectiveMeshField::at(Vec3 x, std::span<const int> triangles,
                                     std::span<const LocalRadius::Segment> edges) const {
    if (triangles.empty()) return {mesh_->contains(x) ? 0.5 : -0.5};
    const LocalRadius::Value r = radius_->at(x, edges);
    const ShareRates v = ball_share_rates(*mesh_, triangles, x, r.radius);
    return {v.value - 0.5, v.gradient + v.by_radius * r.gradient};
}

ValueGradient SelectiveMeshField::at(Vec3 x) const {
    if (!whole_) return at(x, triangles_, edges_);
    const Local l = local({x, x});
    return at(x, l.triangles, l.edges);
}

Range SelectiveMeshField::range(const Box& box) const {
    const Box seen = reached(box);
    if (seen.empty()) return {-0.5, -0.5};
    const Local l = local(seen);
    if (const auto field = constant(l.radius)) return field->range(box);
    const Range here = range(seen, l);
    return seen.lo == box.lo && seen.hi == box.hi ? here : Range{-0.5, here.hi};
}

Range SelectiveMeshField::range(const Box& seen, const Local& l) const {
    const Vec3 center = 0.5 * (seen.lo + seen.hi), half = 0.5 * (seen.hi - seen.lo);
    if (l.triangles.empty()) {
        const double f = mesh_->contains(center) ? 0.5 : -0.5;
        return {f, f};
    }
    const Range radius = l.radius.radius;
    const double reach = glm::length(half), rate = l.radius.rate;
    // Upper bounds of the derivatives of any ball's share, by its place and by its radius, per radius.
    constexpr double by_place = 0.75, by_radius = 3;
    if (reach * (by_place + std::min(by_radius * rate, 1.0)) > 4 * radius.hi) return {-0.5, 0.5};
    const ValueGradient v = at(center, l.triangles, l.edges);
    Rates rates;
    for (const int t : l.triangles) {
        const ClosedMesh::Plane& plane = mesh_->plane(t);
        const double h = plane.offset - glm::dot(plane.normal, center), off = glm::dot(glm::abs(plane.normal), half);
        const ClosedMesh::Ball& ball = mesh_->ball(t);
        const Range distance{h - off, h + off};
        rates.add(steepness_of(*mesh_, t, radius, distance, glm::distance(center, ball.center) + ball.radius + reach),
                  height(radius, distance), 1, 1, rate);
    }
    double off = rates.first(radius.lo, rate) * reach;
    off = std::min(off,
                   glm::dot(glm::abs(v.gradient), half) + 0.5 * rates.second(radius.lo, l.radius.bend) * reach * reach);
    off += 64 * epsilon;
    return {std::max(-0.5, v.value - off), std::min(0.5, v.value + off)};
}

Range SelectiveMeshField::rate_range(const Box& box, Vec3 direction) const {
    const Local l = local(box);
    if (const auto field = constant(l.radius)) return field->rate_range(box, direction);
    if (l.triangles.empty()) return {0, 0};
    const Vec3 center = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    const double reach = glm::length(half);
    const Range radius = l.radius.radius;
    const LocalRadius::Value r = radius_->at(center, l.edges);
    // The range of r′ along the direction.
    const double middle = glm::dot(r.gradient, direction), off = std::min(2 * l.radius.rate, l.radius.bend * reach);
    const Range swell{std::max(middle - off, -l.radius.rate), std::min(middle + off, l.radius.rate)};
    Range sum{0, 0};  // range of Σ aᵢ (nᵢ·u + ηᵢ r′)
    thread_local std::vector<FaceAreas> faces;
    face_areas(*mesh_, l.triangles, center, radius.lo - reach, radius.hi + reach, faces);
    for (const FaceAreas& f : faces) {
        const ClosedMesh::Plane& plane = mesh_->plane(f.triangle);
        const Range area{f.in_least / (radius.hi * radius.hi), std::min(f.in_greatest / (radius.lo * radius.lo), pi)};
        const double h = plane.offset - glm::dot(plane.normal, center), dh = glm::dot(glm::abs(plane.normal), half);
        const auto in_radii = [&](double d) { return std::clamp(d > 0 ? d / radius.lo : d / radius.hi, -1.0, 1.0); };
        const auto least_in_radii = [&](double d) {
            return std::clamp(d > 0 ? d / radius.hi : d / radius.lo, -1.0, 1.0);
        };
        const Range eta{least_in_radii(h - dh), in_radii(h + dh)};
        const double products[] = {eta.lo * swell.lo, eta.lo * swell.hi, eta.hi * swell.lo, eta.hi * swell.hi};
        const double along = glm::dot(plane.normal, direction);
        const Range rate{along + *std::min_element(products, products + 4),
                         along + *std::max_element(products, products + 4)};
        sum.lo += std::min(rate.lo * area.lo, rate.lo * area.hi);
        sum.hi += std::max(rate.hi * area.lo, rate.hi * area.hi);
    }
    const auto scaled = [&](double of, bool up) { return unit * of / ((of > 0) == up ? radius.lo : radius.hi); };
    return {-scaled(sum.hi, true), -scaled(sum.lo, false)};
}

FieldPtr SelectiveMeshField::prune(const Box& box) const {
    const Box seen = reached(box);
    if (seen.empty()) return nullptr;
    const Local l = local(seen);
    if (const auto field = constant(l.radius)) {
        FieldPtr left = field->prune(box);
        return left ? left : field;
    }
    if (l.triangles.empty()) return nullptr;
    if (!whole_ && l.triangles.size() == triangles_.size() && l.edges.size() == edges_.size()) return nullptr;
    return FieldPtr(new SelectiveMeshField(Part{}, *this, l));
}

std::optional<DensityTree> SelectiveMeshField::as_density(const Box& box) const {
    const Box seen = reached(box);
    if (seen.empty()) return std::nullopt;
    // A single plane stays the same plane for smaller balls.
    std::optional<DensityTree> density = full_->as_density(box);
    if (density && density->half_spaces.size() == 1) return density;
    const Local l = local(seen);
    const auto field = constant(l.radius);
    if (!field) return std::nullopt;
    return field == full_ ? density : field->as_density(box);
}

std::vector<HalfSpace> SelectiveMeshField::planes() const {
    if (whole_) return full_->planes();
    constexpr std::size_t few = 32;
    std::vector<HalfSpace> found;
    std::vector<int> ids;
    for (const int t : triangles_) {
        const ClosedMesh::Plane& plane = mesh_->plane(t);
        if (found.size() == few || std::find(ids.begin(), ids.end(), plane.id) != ids.end()) continue;
        ids.push_back(plane.id);
        found.push_back({plane.normal, plane.offset, greatest_});
    }
    // The radius may also change along an edge.
    for (int k = 0; k < 3; ++k) {
        if (std::any_of(found.begin(), found.end(), [&](const HalfSpace& h) { return std::abs(h.normal[k]) > 1e-9; }))
            continue;
        Vec3 axis(0.0);
        axis[k] = 1;
        found.push_back({axis, center_[k], greatest_});
    }
    return found;
}

int SelectiveMeshField::size() const {
    constexpr double triangle = 3;  // cost in half-spaces
    return int(std::min(1e9, std::max(1.0, triangle * double(whole_ ? mesh_->size() : triangles_.size()))));
}

LocalSize SelectiveMeshField::local_size(const Box& box) const {
    // A large box that many triangles reach gets the trivial range: looking at each triangle would hardly prove more.
    const Box seen = reached(box);
    if (seen.empty()) return {{-0.5, -0.5}, 1};
    constexpr std::size_t many = 256;
    constexpr double large = 4;  // shortest side in radii
    const Vec3 sides = seen.hi - seen.lo;
    if (min_component(sides) > large * radius_->full()) {
        const std::size_t count = mesh_->count_near(seen, radius_->full());
        if (count > many) return {{-0.5, 0.5}, int(std::min<std::size_t>(count, 500'000'000) * 2)};
    }
    const Local l = local(seen);
    if (const auto field = constant(l.radius)) return field->local_size(box);
    const Range here = range(seen, l);
    return {seen.lo == box.lo && seen.hi == box.hi ? here : Range{-0.5, here.hi},
            std::max(1, 3 * int(l.triangles.size()))};
}

double SelectiveMeshField::last_sign_change_bound(Vec3 origin, Vec3 direction) const {
    return leaves_box(inflated(mesh_->bounding_box(), radius_->full()), origin, direction);
}

// ray.numbers holds the number of kept edges, their coordinates, then the triangles' numbers.
void SelectiveMeshField::begin_ray(FieldRay& ray) const {
    ray.noise_scale = share_noise_scale;
    ray.numbers.clear();
    const Vec3 a = ray.origin + ray.t0 * ray.direction, b = ray.origin + ray.t1 * ray.direction;
    const Box along{glm::min(a, b), glm::max(a, b)};
    thread_local std::vector<int> found;
    thread_local std::vector<LocalRadius::Segment> edges;
    edges.clear();
    std::span<const LocalRadius::Segment> of = edges_;
    if (whole_) {
        radius_->near(along, edges);
        of = edges;
    }
    ray.numbers.push_back(0);
    for (const LocalRadius::Segment& e : of)
        ray.numbers.insert(ray.numbers.end(), {e.from.x, e.from.y, e.from.z, e.to.x, e.to.y, e.to.z});
    ray.numbers[0] = double(of.size());
    const auto add = [&](int t) {
        const ClosedMesh::Ball& ball = mesh_->ball(t);
        if (distance_to_segment(ball.center, a, b) <= (ball.radius + radius_->full()) * (1 + 16 * epsilon))
            ray.numbers.push_back(t);
    };
    if (whole_) {
        found.clear();
        mesh_->near(along, radius_->full(), found);
        for (const int t : found) add(t);
    } else {
        for (const int t : triangles_) add(t);
    }
}

namespace {

std::span<const double> numbers_of_edges(const FieldRay& ray) {
    return std::span(ray.numbers).subspan(1, 6 * std::size_t(ray.numbers[0]));
}

std::span<const double> numbers_of_triangles(const FieldRay& ray) {
    return std::span(ray.numbers).subspan(1 + 6 * std::size_t(ray.numbers[0]));
}

void edges_of(const FieldRay& ray, std::vector<LocalRadius::Segment>& edges) {
    edges.clear();
    const std::span<const double> n = numbers_of_edges(ray);
    for (std::size_t i = 0; i + 5 < n.size(); i += 6)
        edges.push_back({{n[i], n[i + 1], n[i + 2]}, {n[i + 3], n[i + 4], n[i + 5]}});
}

}  // namespace

ValueSlope SelectiveMeshField::at(const FieldRay& ray, double t) const {
    thread_local std::vector<int> triangles;
    thread_local std::vector<LocalRadius::Segment> edges;
    triangles.clear();
    edges_of(ray, edges);
    const Vec3 x = ray.origin + t * ray.direction;
    for (const double number : numbers_of_triangles(ray)) {
        const ClosedMesh::Ball& ball = mesh_->ball(int(number));
        const Vec3 away = x - ball.center;
        const double reach = ball.radius + radius_->full();
        if (glm::dot(away, away) <= reach * reach) triangles.push_back(int(number));
    }
    const ValueGradient v = at(x, triangles, edges);
    return {v.value / share_noise_scale, glm::dot(v.gradient, ray.direction) / share_noise_scale};
}

RayBounds SelectiveMeshField::bounds(const FieldRay& ray, double t0, double t1) const {
    const double speed = glm::length(ray.direction);
    const Vec3 a = ray.origin + t0 * ray.direction, b = ray.origin + t1 * ray.direction, u = ray.direction / speed;
    thread_local std::vector<LocalRadius::Segment> edges;
    edges_of(ray, edges);
    const LocalRadius::Bounds local = radius_->over({glm::min(a, b), glm::max(a, b)}, edges);
    const Range radius = local.radius;
    Rates rates;
    for (const double number : numbers_of_triangles(ray)) {
        const int t = int(number);
        const ClosedMesh::Ball& ball = mesh_->ball(t);
        if (distance_to_segment(ball.center, a, b) >= ball.radius + radius.hi) continue;
        const ClosedMesh::Plane& plane = mesh_->plane(t);
        const double ha = plane.offset - glm::dot(plane.normal, a), hb = plane.offset - glm::dot(plane.normal, b);
        const Range distance{std::min(ha, hb), std::max(ha, hb)};
        const double farthest = std::max(glm::distance(ball.center, a), glm::distance(ball.center, b)) + ball.radius;
        const double along = std::abs(glm::dot(plane.normal, u)), across = std::sqrt(std::max(0.0, 1 - along * along));
        rates.add(steepness_of(*mesh_, t, radius, distance, farthest), height(radius, distance), along, across,
                  local.rate);
    }
    return {0.5 / share_noise_scale, speed * rates.first(radius.lo, local.rate) / share_noise_scale,
            speed * speed * rates.second(radius.lo, local.bend) / share_noise_scale};
}

const MeshField* mesh_field_of(const Field* field) {
    if (const auto* selective = dynamic_cast<const SelectiveMeshField*>(field)) return &selective->full();
    return dynamic_cast<const MeshField*>(field);
}

}  // namespace deburr
