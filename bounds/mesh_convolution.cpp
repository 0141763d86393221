#include "bounds/mesh_convolution.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace deburr {
namespace {

constexpr double pi = 3.14159265358979323846;

// A point where an edge pierces the sphere. Both triangles of the edge have the same key for it.
struct Piercing {
    int key;
    Vec3 at;  // from the ball's centre, in radii
};

// The part of the edge from a to b in the unit ball: where it enters and leaves. It is computed with the vertices in
// one order whichever triangle asks, so that both triangles get the same bits.
struct Chord {
    bool inside[2] = {false, false};  // whether each end is in the ball
    bool enters = false, leaves = false;
    Vec3 entry{0.0}, exit{0.0};
};

Chord chord_of(Vec3 a, Vec3 b) {
    Chord c;
    const Vec3 d = b - a;
    const double aa = glm::dot(a, a), bb = glm::dot(b, b), dd = glm::dot(d, d), ad = glm::dot(a, d);
    c.inside[0] = aa < 1;
    c.inside[1] = bb < 1;
    if (c.inside[0] && c.inside[1]) return c;
    // The edge's point nearest to the centre, and half of the chord in units of d.
    const bool both_out = !c.inside[0] && !c.inside[1];
    if (both_out && !(ad < 0 && -ad < dd)) return c;
    const double s = -ad / dd;
    const Vec3 foot = a + s * d;
    const double square = 1 - glm::dot(foot, foot);
    if (both_out && !(square > 0)) return c;
    const double half = std::sqrt(std::max(0.0, square) / dd);
    if (!c.inside[0]) {
        c.enters = true;
        c.entry = foot - std::min(half, std::max(s, 0.0)) * d;
    }
    if (!c.inside[1]) {
        c.leaves = true;
        c.exit = foot + std::min(half, std::max(1 - s, 0.0)) * d;
    }
    return c;
}

// A sum of angles in (−π, π] that are given by their sines and cosines, up to a common factor > 0.
class AngleSum {
public:
    void add(double sine, double cosine) {
        const double re = re_ * cosine - im_ * sine, im = re_ * sine + im_ * cosine;
        const bool was_upper = im_ > 0 || (im_ == 0 && re_ > 0), is_upper = im > 0 || (im == 0 && re > 0);
        // A turn by less than π, to the left from the upper half-plane into the lower, or to the right the other way
        // round.
        const double size = std::max(std::abs(re), std::abs(im));
        if (!(size > 0)) return;
        const bool left = sine > 0 || (sine == 0 && cosine < 0);
        if (left && was_upper && !is_upper) ++turns_;
        if (sine < 0 && !was_upper && is_upper) --turns_;
        re_ = re / size;
        im_ = im / size;
    }
    double value() const { return (im_ == 0 && re_ < 0 ? -pi : std::atan2(im_, re_)) + 2 * pi * turns_; }

private:
    double re_ = 1, im_ = 0;
    int turns_ = 0;
};

// Memory that a thread keeps from one evaluation to the next.
struct Scratch {
    struct Arc {
        int from, to;  // keys
    };
    std::vector<Arc> arcs;
    AngleSum turn;  // of the boundary on the sphere, where it passes from one triangle to the next
    std::vector<char> seen;
};

// The number of closed curves that the arcs make up; −1 if an arc ends where none begins, because its triangle is
// missing.
int count_loops(Scratch& scratch) {
    auto& arcs = scratch.arcs;
    std::sort(arcs.begin(), arcs.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
    scratch.seen.assign(arcs.size(), false);
    int loops = 0;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        if (scratch.seen[i]) continue;
        ++loops;
        for (std::size_t at = i; !scratch.seen[at];) {
            scratch.seen[at] = true;
            const auto next = std::lower_bound(arcs.begin(), arcs.end(), arcs[at].to,
                                               [](const auto& arc, int key) { return arc.from < key; });
            if (next == arcs.end() || next->from != arcs[at].to) return -1;
            at = std::size_t(next - arcs.begin());
        }
    }
    return loops;
}

// The part of one triangle in the unit ball around the origin.
class Sector {
public:
    Sector(const ClosedMesh& mesh, int t, Vec3 x, double r) : mesh_(mesh), t_(t), normal_(mesh.plane(t).normal) {
        for (int k = 0; k < 3; ++k) corner_[k] = (mesh.corner(t, k) - x) * (1 / r);
        h_ = (mesh.plane(t).offset - glm::dot(normal_, x)) / r;
    }

    // Computes the part and adds its arcs and turns to `scratch`; false if the ball does not meet the triangle.
    bool find(Scratch& scratch) {
        foot_ = h_ * normal_;
        square_ = std::max(0.0, 1 - h_ * h_);  // of the radius of the circle in which the plane cuts the ball
        int events = 0;
        for (int k = 0; k < 3; ++k) {
            const int l = (k + 1) % 3;
            const ClosedMesh::Corners& v = mesh_.triangles()[t_];
            const bool up = v[k] < v[l];
            Chord c = up ? chord_of(corner_[k], corner_[l]) : chord_of(corner_[l], corner_[k]);
            // A key is twice the edge's number, plus 1 where the edge leaves the ball going from the lesser vertex to
            // the greater.
            const int id = 2 * mesh_.edge_id(t_, k);
            int entry_key = id, exit_key = id + 1;
            if (!up) {
                std::swap(c.inside[0], c.inside[1]);
                std::swap(c.enters, c.leaves);
                std::swap(c.entry, c.exit);
                std::swap(entry_key, exit_key);
            }
            const bool has_part = c.inside[0] || c.inside[1] || c.enters;
            if (!has_part) continue;
            const Vec3 from = c.inside[0] ? corner_[k] : c.entry, to = c.inside[1] ? corner_[l] : c.exit;
            twice_area_ += cross(from - foot_, to - foot_);
            if (c.enters) event_[events++] = {{entry_key, c.entry}, k, true};
            if (c.leaves) {
                event_[events++] = {{exit_key, c.exit}, k, false};
                add_turn(k, c.exit, scratch.turn);
            }
            any_ = true;
        }
        if (events == 0) {
            if (any_) return true;  // all of the triangle is in the ball
            if (square_ == 0) return false;
            for (int k = 0; k < 3; ++k)
                if (cross(corner_[k] - foot_, corner_[(k + 1) % 3] - foot_) <= 0) return false;
            arcs_ = 2 * pi;
            ++loops_;
            twice_area_ = square_ * arcs_;
            return true;
        }
        // Arcs of the circle, from where the triangle's border leaves the ball to where it comes back.
        for (int i = 0; i < events; ++i) {
            if (event_[i].enters) continue;
            const Event &out = event_[i], &in = event_[(i + 1) % events];
            const double angle = arc(out, in);
            arcs_ += angle;
            twice_area_ += square_ * angle;
            // With the solid on the left the arc runs the other way.
            scratch.arcs.push_back({in.piercing.key, out.piercing.key});
        }
        return true;
    }

    /// Signed distance of the plane, in radii.
    double h() const { return h_; }
    double area() const { return 0.5 * twice_area_; }  // |D| in squared radii
    /// The sum of the arcs' angles, and the number of whole circles in the triangle.
    double arcs() const { return arcs_; }
    int loops() const { return loops_; }

private:
    struct Event {
        Piercing piercing;
        int edge;
        bool enters;
    };

    double cross(Vec3 a, Vec3 b) const { return glm::dot(normal_, glm::cross(a, b)); }
    double angle(Vec3 a, Vec3 b) const {
        return std::atan2(cross(a - foot_, b - foot_), glm::dot(a - foot_, b - foot_));
    }

    // The angle of the arc, counter-clockwise. Where it is either short or nearly the whole circle, the triangle's
    // border tells which: outside of the circle both go around equally far.
    double arc(const Event& out, const Event& in) const {
        const double direct = angle(out.piercing.at, in.piercing.at);
        constexpr double sure = 1e-3;
        if (std::abs(direct) > sure) return direct < 0 ? direct + 2 * pi : direct;
        double around = 0;
        Vec3 at = out.piercing.at;
        int k = out.edge;
        do {
            k = (k + 1) % 3;
            around += angle(at, corner_[k]);
            at = corner_[k];
        } while (k != in.edge);
        around += angle(at, in.piercing.at);
        return around > pi ? direct + 2 * pi : direct;
    }

    // Adds the left turn of the solid's boundary on the sphere where it passes at y across edge k to the next triangle.
    void add_turn(int k, Vec3 y, AngleSum& turn) const {
        const ClosedMesh::Plane &here = mesh_.plane(t_), &there = mesh_.plane(mesh_.across(t_, k).triangle);
        if (here.id == there.id) return;
        turn.add(glm::dot(y, glm::cross(here.normal, there.normal)),
                 glm::dot(here.normal, there.normal) - glm::dot(y, here.normal) * glm::dot(y, there.normal));
    }

    const ClosedMesh& mesh_;
    int t_;
    Vec3 normal_;
    Vec3 corner_[3];
    double h_;
    Vec3 foot_{0.0};
    double square_ = 0, twice_area_ = 0, arcs_ = 0;
    Event event_[6];
    bool any_ = false;
    int loops_ = 0;
};

// Sets `v`; returns false, with an approximation in `v`, if a triangle that the sphere cuts is missing.
bool sum_up(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r, ShareRates& v) {
    thread_local Scratch scratch;
    scratch.arcs.clear();
    scratch.turn = {};
    double share = 0, heights = 0;  // heights: Σ h |D|
    int loops = 0;
    Vec3 areas(0.0);
    // Triangles farther outside or inside of the sphere than this are not cut by it, whatever rounding does.
    const double rounding = 1e-9 * r + 16 * epsilon * (largest(glm::abs(x)) + r);
    for (const int t : triangles) {
        const ClosedMesh::Ball& ball = mesh.ball(t);
        const ClosedMesh::Plane& plane = mesh.plane(t);
        const Vec3 away = ball.center - x;
        const double square = glm::dot(away, away), reach = ball.radius + r + rounding;
        if (square >= reach * reach) continue;
        const double h = plane.offset - glm::dot(plane.normal, x);
        if (std::abs(h) > r + rounding) continue;
        const double within = r - ball.radius - rounding;
        if (within > 0 && square < within * within) {
            const double area = mesh.area(t) / (r * r);
            areas += area * plane.normal;
            share += h / r * area;
            heights += h / r * area;
            continue;
        }
        Sector sector(mesh, t, x, r);
        if (!sector.find(scratch)) continue;
        areas += sector.area() * plane.normal;
        share += sector.h() * (sector.area() + sector.arcs());
        heights += sector.h() * sector.area();
        loops += sector.loops();
    }
    const int curves = scratch.arcs.empty() ? 0 : count_loops(scratch);
    share = (share - scratch.turn.value()) / (4 * pi) - 0.5 * (loops + std::max(0, curves));
    share -= std::floor(share);
    // The sum is determined up to whole numbers, which matters only between 0 and 1.
    constexpr double near_whole = 1e-7;
    if (share < near_whole || share > 1 - near_whole) {
        const bool in = mesh.contains(x, triangles, r);
        const double off = share < 0.5 ? share : share - 1;
        share = in ? std::min(1.0, 1 + off) : std::max(0.0, off);
    }
    v = {share, areas * (-3 / (4 * pi * r)), heights * (-3 / (4 * pi * r))};
    return curves >= 0;
}

}  // namespace

ValueGradient ball_share(const ClosedMesh& mesh, Vec3 x, double r) {
    thread_local std::vector<int> near;
    near.clear();
    mesh.near({x, x}, r, near);
    ShareRates v;
    sum_up(mesh, near, x, r, v);
    return {v.value, v.gradient};
}

ValueGradient ball_share(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r) {
    ShareRates v;
    if (!sum_up(mesh, triangles, x, r, v)) return ball_share(mesh, x, r);
    return {v.value, v.gradient};
}

ShareRates ball_share_rates(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r) {
    ShareRates v;
    if (sum_up(mesh, triangles, x, r, v)) return v;
    thread_local std::vector<int> near;
    near.clear();
    mesh.near({x, x}, r, near);
    sum_up(mesh, near, x, r, v);
    return v;
}

double area_in_ball(const ClosedMesh& mesh, int triangle, Vec3 x, double r) {
    const ClosedMesh::Plane& plane = mesh.plane(triangle);
    if (!(r > 0) || std::abs(plane.offset - glm::dot(plane.normal, x)) >= r) return 0;
    thread_local Scratch scratch;
    scratch.arcs.clear();
    scratch.turn = {};
    Sector sector(mesh, triangle, x, r);
    return sector.find(scratch) ? sector.area() * r * r : 0;
}

}  // namespace deburr
