#include "polygonizer/octree/octree_points.hpp"

#include <algorithm>

namespace deburr {
namespace {

struct TangentPlane {
    Vec3 normal;
    double offset;
};

// The shortest x with the least sum of (n·x − offset)². Directions whose eigenvalue is below this fraction of the
// greatest are left out, as the planes say too little about them.
Vec3 nearest_to_all(const std::vector<TangentPlane>& planes, double min_share) {
    Mat3 a(0.0);
    Vec3 b(0.0);
    for (const TangentPlane& p : planes) {
        a += glm::outerProduct(p.normal, p.normal);
        b += p.normal * p.offset;
    }
    const auto [v, value] = eigensystem(a);
    const double largest = std::max({value[0], value[1], value[2]});
    Vec3 x(0.0);
    for (int k = 0; k < 3; ++k)
        if (value[k] > min_share * largest) x += v[k] * (glm::dot(v[k], b) / value[k]);
    return x;
}

// Distances below this, relative to the cell, count as 0.
constexpr double on_surface = 1e-13;
// Distances that are accepted where rounding stops Newton's method.
constexpr double nearly_on_surface = 1e-9;
constexpr int max_steps = 30;

double size_of(const Box& cell) { return glm::length(cell.hi - cell.lo); }

/// x moved into the cell, a little off its walls.
Vec3 clamped(Vec3 x, const Box& cell) {
    constexpr double inward = 1e-3;
    const Vec3 by = inward * (cell.hi - cell.lo);
    return glm::clamp(x, cell.lo + by, cell.hi - by);
}

// The point where all pieces are 0, by the Gauss–Newton method; none if there is none within the box.
std::optional<Vec3> meeting_point(const SignedDistance& solid, const std::vector<SmoothPiece>& pieces, Vec3 x,
                                  const Box& within) {
    // The eigenvalue of two tangent planes at an angle of 1° is more than this fraction of the greatest.
    constexpr double min_share = 1e-5;
    const double size = size_of(within);
    std::vector<TangentPlane> planes(pieces.size());
    for (int step = 0; step < max_steps; ++step) {
        double farthest = 0;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const SurfaceSample o = solid.piece_at(pieces[k], x);
            if (!std::isfinite(o.distance) || o.normal == Vec3(0.0)) return std::nullopt;
            planes[k] = {o.normal, o.distance};
            farthest = std::max(farthest, std::abs(o.distance));
        }
        if (farthest < on_surface * size) break;
        if (step + 1 == max_steps && farthest > nearly_on_surface * size) return std::nullopt;
        x += nearest_to_all(planes, min_share);
        if (!inflated(within, size).contains(x)) return std::nullopt;
    }
    if (!within.contains(x) || !(std::abs(solid.at(x).distance) < nearly_on_surface * size)) return std::nullopt;
    return x;
}

bool is_hard(const std::vector<Face>& faces, double hard_cosine) {
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (glm::dot(faces[i].normal, faces[j].normal) < hard_cosine) return true;
    return false;
}

/// The point where the pieces meet, if they meet at a hard edge.
std::optional<SurfacePoint> hard_point(const SignedDistance& solid, const std::vector<SmoothPiece>& pieces, Vec3 from,
                                       const Box& within, double hard_cosine) {
    const auto x = meeting_point(solid, pieces, from, within);
    if (!x) return std::nullopt;
    SurfacePoint point{*x, {}};
    for (const SmoothPiece& p : pieces) point.faces.push_back(face_of(solid, solid.piece_at(p, *x)));
    if (!is_hard(point.faces, hard_cosine)) return std::nullopt;
    return point;
}

// The surface's pieces, faces and tangent planes at the crossings of a cell.
struct Seen {
    std::vector<SmoothPiece> pieces;
    std::vector<Face> faces;  // of all crossings
    std::vector<TangentPlane> planes;
};

/// Adds the surface at the crossing x; planes are relative to `origin`.
void see(const SignedDistance& solid, Vec3 x, Vec3 origin, Seen& seen) {
    const SurfaceSample o = solid.at(x);
    if (o.leaf < 0 || o.normal == Vec3(0.0)) return;
    SmoothPiece piece{o.leaf, o.plane, 1};
    if (glm::dot(solid.piece_at(piece, x).normal, o.normal) < 0) piece.side = -1;
    if (std::find(seen.pieces.begin(), seen.pieces.end(), piece) == seen.pieces.end()) seen.pieces.push_back(piece);
    seen.faces.push_back(face_of(solid, o));
    seen.planes.push_back({o.normal, glm::dot(o.normal, x - origin)});
}

// The tip of a cone, where its tangent planes meet. It may stick out of the cell with the cone's last crossings, into a
// cell none of whose edges the cone crosses.
std::optional<SurfacePoint> tip_point(const SignedDistance& solid, const Box& cell, Vec3 mean, const Seen& seen) {
    const Vec3 x = mean + nearest_to_all(seen.planes, 0);
    const double size = size_of(cell);
    for (const TangentPlane& p : seen.planes)
        if (std::abs(glm::dot(p.normal, x - mean) - p.offset) > nearly_on_surface * size) return std::nullopt;
    if (!inflated(cell, cell.hi.x - cell.lo.x).contains(x) ||
        !(std::abs(solid.at(x).distance) < nearly_on_surface * size))
        return std::nullopt;
    return SurfacePoint{x, seen.faces};  // a tip faces all ways at once
}

// Moves `start` from the cell to the surface by Newton's method; if that leaves the cell, along the line to the nearest
// end of a crossing on the other side.
Vec3 taken_to_surface(const SignedDistance& solid, const Box& cell, const std::vector<CrossingPoint>& crossings,
                      Vec3 start) {
    const double size = size_of(cell);
    Vec3 x = start;
    for (int step = 0; step < max_steps && cell.contains(x); ++step) {
        const SurfaceSample o = solid.at(x);
        if (std::abs(o.distance) < on_surface * size) return x;
        if (!std::isfinite(o.distance) || o.normal == Vec3(0.0)) break;
        x += o.normal * o.distance;
    }
    if (cell.contains(x) && std::abs(solid.at(x).distance) < 10 * on_surface * size) return x;
    const bool inside = solid.inside(start);
    Vec3 end = inside ? crossings[0].outside : crossings[0].inside;
    for (const CrossingPoint& c : crossings) {
        const Vec3 other = inside ? c.outside : c.inside;
        if (glm::length(other - start) < glm::length(end - start)) end = other;
    }
    return inside ? surface_root(solid, start, end) : surface_root(solid, end, start);
}

}  // namespace

Face face_of(const SignedDistance& solid, const SurfaceSample& there) {
    if (there.leaf < 0) return {there.normal};
    return {there.normal, solid.material(there.leaf), solid.sharp(there.leaf) ? -1 : solid.line(there.leaf)};
}

Vec3 surface_root(const SignedDistance& solid, Vec3 inside, Vec3 outside) {
    // The Illinois method, which keeps the root bracketed, with bisection every fourth step and where a density is
    // saturated.
    const Vec3 d = outside - inside;
    double t0 = 0, t1 = 1;
    double f0 = solid.at(inside).distance, f1 = solid.at(outside).distance;
    int last = 0;
    for (int step = 0; step < 200; ++step) {
        double t = 0.5 * (t0 + t1);
        if (std::isfinite(f0) && std::isfinite(f1) && f0 > f1 && step % 4 != 3) t = t0 + (t1 - t0) * (f0 / (f0 - f1));
        if (t <= t0 || t >= t1) t = 0.5 * (t0 + t1);
        if (t <= t0 || t >= t1 || t1 - t0 < 2 * epsilon) break;
        const Vec3 x = inside + d * t;
        const double f = solid.at(x).distance;
        if (f == 0) return x;
        if (f > 0) {
            t0 = t;
            f0 = f;
            if (last == 1) f1 *= 0.5;
            last = 1;
        } else {
            t1 = t;
            f1 = f;
            if (last == -1) f0 *= 0.5;
            last = -1;
        }
        if (std::abs(f) < on_surface * glm::length(d)) return x;
    }
    return inside + d * (0.5 * (t0 + t1));
}

SurfacePoint surface_point(const SignedDistance& solid, const Box& cell, const std::vector<CrossingPoint>& crossings,
                           double hard_cosine, bool tip_may_stick_out) {
    Vec3 mean(0.0), normal(0.0);
    for (const CrossingPoint& c : crossings) mean += c.position / double(crossings.size());
    Seen seen;
    for (const CrossingPoint& c : crossings) see(solid, c.position, mean, seen);
    Vec3 start = mean;
    const bool bent = is_hard(seen.faces, hard_cosine);
    if (bent && seen.pieces.size() == 1)
        if (const auto tip = tip_point(solid, cell, mean, seen);
            tip && (tip_may_stick_out || cell.contains(tip->position)))
            return *tip;
    if (bent) {
        // Two planes at an angle θ have eigenvalues in the ratio tan²(θ/2), which is about this at 11°: flatter hard
        // edges say too little about the direction across them.
        constexpr double min_share = 0.01;
        start = clamped(mean + nearest_to_all(seen.planes, min_share), cell);
        if (seen.pieces.size() > 1) {
            if (auto corner = hard_point(solid, seen.pieces, start, cell, hard_cosine)) return *corner;
            std::optional<SurfacePoint> best;
            for (std::size_t i = 0; i < seen.pieces.size() && seen.pieces.size() > 2; ++i)
                for (std::size_t j = 0; j < i; ++j)
                    if (const auto p = hard_point(solid, {seen.pieces[i], seen.pieces[j]}, start, cell, hard_cosine))
                        if (!best || glm::length(p->position - mean) < glm::length(best->position - mean)) best = p;
            if (best) return *best;
        }
    }
    SurfacePoint point{taken_to_surface(solid, cell, crossings, start), {}};
    const SurfaceSample o = solid.at(point.position);
    for (const Face& f : seen.faces) normal += f.normal;
    point.faces.push_back(face_of(solid, o));
    Vec3& first = point.faces[0].normal;
    if (first == Vec3(0.0)) first = glm::length(normal) > 0 ? glm::normalize(normal) : Vec3(0, 0, 1);
    return point;
}

namespace {

/// The pieces that pass within `tolerance` of x.
std::vector<SmoothPiece> pieces_through(const SignedDistance& solid, const std::vector<SmoothPiece>& all, Vec3 x,
                                        double tolerance) {
    std::vector<SmoothPiece> through;
    for (const SmoothPiece& p : all)
        if (std::abs(solid.piece_at(p, x).distance) < tolerance) through.push_back(p);
    return through;
}

std::vector<SmoothPiece> common(const std::vector<SmoothPiece>& a, const std::vector<SmoothPiece>& b) {
    std::vector<SmoothPiece> both;
    for (const SmoothPiece& p : a)
        if (std::find(b.begin(), b.end(), p) != b.end()) both.push_back(p);
    return both;
}

std::optional<SurfacePoint> meeting_near(const SignedDistance& solid, Vec3 x, const std::vector<SmoothPiece>& pieces,
                                         double reach, double hard_cosine) {
    const auto point = hard_point(solid, pieces, x, {x - Vec3(reach), x + Vec3(reach)}, hard_cosine);
    return point && glm::length(point->position - x) <= reach ? point : std::nullopt;
}

// A point is on a piece if it is nearer to it than this, relative to the mesh's edge.
constexpr double on_piece = 1e-7;

}  // namespace

std::optional<SurfacePoint> hard_edge_point(const SignedDistance& solid, Vec3 x, Vec3 p, Vec3 q, double reach,
                                            double hard_cosine) {
    const auto all = solid.pieces();
    const double tolerance = on_piece * glm::length(p - q);
    const auto pieces = common(pieces_through(solid, all, p, tolerance), pieces_through(solid, all, q, tolerance));
    return pieces.size() == 2 ? meeting_near(solid, x, pieces, reach, hard_cosine) : std::nullopt;
}

std::optional<SurfacePoint> cut_off_point(const SignedDistance& solid, const std::vector<Vec3>& points, Vec3 x,
                                          double hard_cosine) {
    const auto all = solid.pieces();
    double apart = 0;
    for (const Vec3 point : points) apart = std::max(apart, glm::length(point - points[0]));
    std::vector<std::vector<SmoothPiece>> through;
    std::vector<SmoothPiece> any, every;
    for (const Vec3 point : points) {
        through.push_back(pieces_through(solid, all, point, on_piece * apart));
        every = through.size() == 1 ? through[0] : common(every, through.back());
        for (const SmoothPiece& p : through.back())
            if (std::find(any.begin(), any.end(), p) == any.end()) any.push_back(p);
    }
    if (!every.empty()) return std::nullopt;
    if (any.size() == points.size() || any.size() == 3)
        if (const auto point = meeting_near(solid, x, any, apart, hard_cosine)) return point;
    if (points.size() != 2) return std::nullopt;
    std::optional<SurfacePoint> best;
    for (const SmoothPiece& a : through[0])
        for (const SmoothPiece& b : through[1]) {
            const auto point = meeting_near(solid, x, {a, b}, apart, hard_cosine);
            if (point && (!best || glm::length(point->position - x) < glm::length(best->position - x))) best = point;
        }
    return best;
}

}  // namespace deburr
