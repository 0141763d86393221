#include "bounds/mesh_convolution.hpp"

#include <algorithm>
#include <vector>

#include "bounds/index_map.hpp"
#include "bounds/mesh_steepness.hpp"
#include "bounds/triangle_in_ball.hpp"

namespace deburr {
namespace {

// A sum of angles in (−π, π] that are given by their sines and cosines, up to a common factor > 0.
class AngleSum {
public:
    void add(double sine, double cosine) {
        const double re = re_ * cosine - im_ * sine, im = re_ * sine + im_ * cosine;
        const bool was_upper = im_ > 0 || (im_ == 0 && re_ > 0), is_upper = im > 0 || (im == 0 && re > 0);
        const double size = std::max(std::abs(re), std::abs(im));
        if (!(size > 0)) return;
        // A turn by less than π, to the left from the upper half-plane into the lower, or to the right the other way
        // round.
        const bool left = sine > 0 || (sine == 0 && cosine < 0);
        if (left && was_upper && !is_upper) ++turns_;
        if (sine < 0 && !was_upper && is_upper) --turns_;
        const double scale = size > least_size && size < 1 / least_size ? 1 : 1 / size;
        re_ = re * scale;
        im_ = im * scale;
    }
    double value() const { return (im_ == 0 && re_ < 0 ? -pi : std::atan2(im_, re_)) + 2 * pi * turns_; }

private:
    static constexpr double least_size = 0x1p-64;  // of the product that is not scaled

    double re_ = 1, im_ = 0;
    int turns_ = 0;
};

// The number of closed curves that the arcs make up; −1 if an arc ends where none begins. `starts` is overwritten.
int count_loops(std::vector<Arc>& arcs, IndexMap& starts) {
    starts.reset(arcs.size());
    for (std::size_t i = 0; i < arcs.size(); ++i) starts.find_or_insert(arcs[i].from, int(i));
    int loops = 0;
    for (Arc& first : arcs) {
        if (first.to < 0) continue;
        ++loops;
        for (Arc* arc = &first; arc->to >= 0;) {
            const int next = starts.find(arc->to);
            if (next < 0) return -1;
            arc->to = -1;  // has been counted
            arc = &arcs[std::size_t(next)];
        }
    }
    return loops;
}

// Sums up the shares of the faces of a mesh in a ball. A face is made of all triangles in one plane: edges between them
// count for nothing, and an edge between two faces is looked at once for both.
class FaceSums {
public:
    // Sets `v`; returns false, with an approximation in `v`, if the ball holds a part of an edge of which one triangle
    // is not among `triangles`.
    bool find(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r, ShareRates& v) {
        prepare(mesh, triangles, x, r);
        double share = 0, heights = 0;  // heights: Σ h |D|
        int circles = 0;
        Vec3 areas(0.0);
        for (const Face& f : faces_) {
            const PlanePart part = part_of(f);
            areas += part.area * f.normal;
            share += f.h * (part.area + part.arcs);
            heights += f.h * part.area;
            circles += part.circles;
        }
        const int loops = count_loops(arcs_, index_);
        const bool is_complete = std::none_of(faces_.begin(), faces_.end(), [](const Face& f) { return f.open; });
        share = (share - turn_.value()) / (4 * pi) - 0.5 * (circles + std::max(0, loops));
        share -= std::floor(share);
        // The sum is determined up to whole numbers, which matters only between 0 and 1.
        constexpr double near_whole = 1e-7;
        if (share < near_whole || share > 1 - near_whole) {
            const bool in = mesh.contains(x, triangles, r);
            const double off = share < 0.5 ? share : share - 1;
            share = in ? std::min(1.0, 1 + off) : std::max(0.0, off);
        }
        v = {share, areas * (-3 / (4 * pi * r)), heights * (-3 / (4 * pi * r))};
        return is_complete && loops >= 0;
    }

    // Calls visit(triangle, area) with one triangle of each face that the ball meets, and the area in the ball of those
    // of the face's triangles that are given.
    template <class Visit>
    void areas(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r, Visit visit) {
        prepare(mesh, triangles, x, r);
        for (const Face& f : faces_)
            if (const double area = part_of(f).area; area > 0)
                visit(near_[std::size_t(f.first)].triangle, area * r * r);
    }

private:
    // A face of which some triangle may reach the ball.
    struct Face {
        Vec3 normal;
        double h;                  // signed distance of the plane, in radii
        int first = -1;            // of the face's triangles, an index of near_
        bool any_inside = false;   // any triangle is in the ball as a whole; its edges are not among these
        double cross_sum = 0;      // twice the area of whole triangles, and between the centre's foot and edges
        int held = 0, missed = 0;  // edges that have a part in the ball, and edges that have none
        bool open = false;         // a triangle is missing at an edge that has a part in the ball
        int passes = -1;           // where the face's border leaves the ball or comes back, an index of passes_
    };
    // A place where the boundary on the sphere passes from one face to another.
    struct Pass {
        Piercing piercing;
        bool leaves;  // whether the face's border leaves the ball there, or comes back
        int next;     // pass of the face, an index of passes_; −1 ends the list
        double angle = 0;
    };
    // A triangle that may reach the ball.
    struct Near {
        int triangle;
        int face;
        int next;     // triangle of the face, an index of near_; −1 ends the list
        bool inside;  // the whole triangle is in the ball
    };

    double height(const ClosedMesh::Plane& plane) const { return plane.offset - glm::dot(plane.normal, x_); }
    // Whether the plane does not reach the ball.
    bool is_beyond(const ClosedMesh::Plane& plane) const { return std::abs(height(plane)) > reach_; }
    Vec3 place(int vertex) const { return (mesh_->vertices()[std::size_t(vertex)] - x_) * (1 / r_); }

    // Finds the faces near the ball, and what all edges add to them.
    void prepare(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r) {
        mesh_ = &mesh;
        x_ = x;
        r_ = r;
        passes_.clear();
        arcs_.clear();
        turn_ = {};
        gather(triangles);
        for (const Near& n : near_)
            for (int k = 0; k < 3 && !n.inside; ++k) look_at_edge(n, k);
    }

    void gather(std::span<const int> triangles) {
        near_.clear();
        faces_.clear();
        index_.reset(triangles.size());
        // Triangles farther outside or inside of the sphere than this are not cut by it, whatever rounding does.
        const double rounding = 1e-9 * r_ + 16 * epsilon * (largest(x_) + r_);
        reach_ = r_ + rounding;
        for (const int t : triangles) {
            const ClosedMesh::Ball& ball = mesh_->ball(t);
            const ClosedMesh::Plane& plane = mesh_->plane(t);
            const Vec3 away = ball.center - x_;
            const double square = glm::dot(away, away), within = r_ - ball.radius - rounding;
            if (square >= (ball.radius + reach_) * (ball.radius + reach_)) continue;
            if (is_beyond(plane)) continue;
            const int f = index_.find_or_insert(plane.id, int(faces_.size()));
            if (f == int(faces_.size())) faces_.push_back({.normal = plane.normal, .h = height(plane) / r_});
            Face& face = faces_[std::size_t(f)];
            const bool inside = within > 0 && square < within * within;
            if (inside) face.cross_sum += 2 * mesh_->area(t) / (r_ * r_);
            face.any_inside |= inside;
            near_.push_back({t, f, face.first, inside});
            face.first = int(near_.size()) - 1;
        }
        index_.reset(near_.size());
        for (std::size_t i = 0; i < near_.size(); ++i) index_.find_or_insert(near_[i].triangle, int(i));
    }

    void look_at_edge(const Near& n, int k) {
        const int other = mesh_->across(n.triangle, k).triangle, m = index_.find(other);
        Face& here = faces_[std::size_t(n.face)];
        const bool beside_inside = m >= 0 && near_[std::size_t(m)].inside;
        if (m >= 0 && !beside_inside && (near_[std::size_t(m)].face == n.face || other < n.triangle)) return;
        if (m < 0 && is_beyond(mesh_->plane(other))) {
            ++here.missed;
            return;
        }
        const ClosedMesh::Corners& v = mesh_->triangles()[std::size_t(n.triangle)];
        const int v0 = v[std::size_t(k)], v1 = v[std::size_t((k + 1) % 3)];
        const Vec3 a = place(std::min(v0, v1)), b = place(std::max(v0, v1));
        const Chord c = chord_of(a, b);
        const bool has_part = c.inside[0] || c.inside[1] || c.enters;
        ++(has_part ? here.held : here.missed);
        if (beside_inside) {
            here.cross_sum += glm::dot(here.normal, v0 < v1 ? glm::cross(a, b) : glm::cross(b, a));
            return;
        }
        if (m < 0) {
            here.open |= has_part;
            return;
        }
        Face& there = faces_[std::size_t(near_[std::size_t(m)].face)];
        ++(has_part ? there.held : there.missed);
        if (!has_part) return;
        Face &left = v0 < v1 ? here : there, &right = v0 < v1 ? there : here;
        const Vec3 area = glm::cross(c.inside[0] ? a : c.entry, c.inside[1] ? b : c.exit);
        left.cross_sum += glm::dot(left.normal, area);
        right.cross_sum -= glm::dot(right.normal, area);
        const int key = 2 * mesh_->edge_id(n.triangle, k);
        if (c.enters) pass({key, c.entry}, right, left);
        if (c.leaves) pass({key + 1, c.exit}, left, right);
    }

    // The boundary on the sphere passes from one face to another: where the border of `from` leaves the ball that of
    // `to` comes back, and the solid's boundary turns to the left by an angle.
    void pass(const Piercing& p, Face& from, Face& to) {
        passes_.push_back({p, true, from.passes});
        from.passes = int(passes_.size()) - 1;
        passes_.push_back({p, false, to.passes});
        to.passes = int(passes_.size()) - 1;
        turn_.add(glm::dot(p.at, glm::cross(from.normal, to.normal)),
                  glm::dot(from.normal, to.normal) - glm::dot(p.at, from.normal) * glm::dot(p.at, to.normal));
    }

    PlanePart part_of(const Face& f) {
        if (f.open) return part_by_triangles(f);
        const double square = std::max(0.0, 1 - f.h * f.h);  // of the radius of the plane's circle
        if (f.passes >= 0) return part_with_arcs(f, square);
        const bool holds_face = f.missed == 0, holds_whole_triangles_only = f.held == 0 && f.any_inside;
        if (holds_face || holds_whole_triangles_only) return {.area = 0.5 * f.cross_sum};
        if (f.held == 0) {
            const Side side = square > 0 ? side_of_foot(f) : Side::out;
            if (side == Side::out) return {};
            if (side == Side::in) return {pi * square, 2 * pi, 1};
        }
        return part_by_triangles(f);
    }

    // The arcs run counter-clockwise around the plane's circle from where the face's border leaves the ball to where it
    // comes back, if their ends are so far apart that their order is sure.
    PlanePart part_with_arcs(const Face& f, double square) {
        const Vec3 foot = f.h * f.normal, first = passes_[std::size_t(f.passes)].piercing.at - foot;
        around_.clear();
        for (int i = f.passes; i >= 0; i = passes_[std::size_t(i)].next) {
            Pass& pass = passes_[std::size_t(i)];
            const Vec3 at = pass.piercing.at - foot;
            pass.angle = i == f.passes ? 0 : std::atan2(glm::dot(f.normal, glm::cross(first, at)), glm::dot(first, at));
            if (pass.angle < 0) pass.angle += 2 * pi;
            around_.push_back(&pass);
        }
        std::sort(around_.begin(), around_.end(), [](const Pass* p, const Pass* q) { return p->angle < q->angle; });
        constexpr double sure = 1e-3;
        const std::size_t n = around_.size(), arcs_before = arcs_.size();
        PlanePart part;
        for (std::size_t i = 0; i < n; ++i) {
            const Pass &p = *around_[i], &q = *around_[(i + 1) % n];
            const double angle = q.angle - p.angle + (i + 1 == n ? 2 * pi : 0);
            if (p.leaves == q.leaves || angle < sure) {
                arcs_.resize(arcs_before);
                return part_by_triangles(f);
            }
            if (!p.leaves) continue;
            part.arcs += angle;
            // With the solid on the left the arc runs the other way.
            arcs_.push_back({q.piercing.key, p.piercing.key});
        }
        part.area = 0.5 * (f.cross_sum + square * part.arcs);
        return part;
    }

    // Where the foot of the ball's centre on the face's plane is: in one of the face's triangles, out of all of them,
    // or so near to an edge that rounding may decide.
    enum class Side { in, out, unsure };
    Side side_of_foot(const Face& f) const {
        Side side = Side::out;
        const Vec3 foot = f.h * f.normal;
        for (int i = f.first; i >= 0; i = near_[std::size_t(i)].next) {
            const ClosedMesh::Corners& v = mesh_->triangles()[std::size_t(near_[std::size_t(i)].triangle)];
            const Vec3 a = place(v[0]) - foot, b = place(v[1]) - foot, c = place(v[2]) - foot;
            const double least =
                min_component({glm::dot(f.normal, glm::cross(a, b)), glm::dot(f.normal, glm::cross(b, c)),
                               glm::dot(f.normal, glm::cross(c, a))});
            const double rounding = 64 * epsilon * (glm::dot(a, a) + glm::dot(b, b) + glm::dot(c, c));
            if (least > rounding) return Side::in;
            if (least >= -rounding) side = Side::unsure;
        }
        return side;
    }

    PlanePart part_by_triangles(const Face& f) {
        PlanePart sum;
        for (int i = f.first; i >= 0; i = near_[std::size_t(i)].next) {
            const PlanePart part = triangle_in_ball(*mesh_, near_[std::size_t(i)].triangle, x_, r_, arcs_);
            sum.area += part.area;
            sum.arcs += part.arcs;
            sum.circles += part.circles;
        }
        return sum;
    }

    const ClosedMesh* mesh_ = nullptr;
    Vec3 x_{0.0};
    double r_ = 0, reach_ = 0;  // reach_: the radius, and what rounding may add to it
    // Memory is kept from one evaluation to the next.
    std::vector<Near> near_;
    std::vector<Face> faces_;
    std::vector<Pass> passes_;
    std::vector<const Pass*> around_;
    std::vector<Arc> arcs_;
    IndexMap index_;  // of faces by their planes, of triangles, of arcs
    AngleSum turn_;   // of the boundary on the sphere, where it passes from one face to the next
};

bool sum_up(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r, ShareRates& v) {
    thread_local FaceSums sums;
    return sums.find(mesh, triangles, x, r, v);
}

// The triangles that reach the ball; valid until the thread asks again.
std::span<const int> triangles_near(const ClosedMesh& mesh, Vec3 x, double r) {
    thread_local std::vector<int> near;
    near.clear();
    mesh.near({x, x}, r, near);
    return near;
}

}  // namespace

ShareRates ball_share_rates(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r) {
    ShareRates v;
    if (!sum_up(mesh, triangles, x, r, v)) sum_up(mesh, triangles_near(mesh, x, r), x, r, v);
    return v;
}

ValueGradient ball_share(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double r) {
    const ShareRates v = ball_share_rates(mesh, triangles, x, r);
    return {v.value, v.gradient};
}

ValueGradient ball_share(const ClosedMesh& mesh, Vec3 x, double r) {
    ShareRates v;
    sum_up(mesh, triangles_near(mesh, x, r), x, r, v);
    return {v.value, v.gradient};
}

void face_areas(const ClosedMesh& mesh, std::span<const int> triangles, Vec3 x, double least, double greatest,
                std::vector<FaceAreas>& found) {
    thread_local FaceSums sums;
    thread_local IndexMap by_plane;
    found.clear();
    if (!(greatest > 0)) return;
    sums.areas(mesh, triangles, x, greatest, [&](int t, double area) { found.push_back({t, 0, area}); });
    if (!(least > 0)) return;
    by_plane.reset(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) by_plane.find_or_insert(mesh.plane(found[i].triangle).id, int(i));
    sums.areas(mesh, triangles, x, least, [&](int t, double area) {
        if (const int i = by_plane.find(mesh.plane(t).id); i >= 0)
            found[std::size_t(i)].in_least = std::min(area, found[std::size_t(i)].in_greatest);
    });
}

}  // namespace deburr
