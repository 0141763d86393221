#include "bounds/triangle_in_ball.hpp"

#include <algorithm>
#include <utility>

#include "bounds/mesh_steepness.hpp"

namespace deburr {
namespace {

// The part of one triangle in the unit ball around the origin.
class TriangleInBall {
public:
    TriangleInBall(const ClosedMesh& mesh, int t, Vec3 x, double r)
        : mesh_(mesh), t_(t), normal_(mesh.plane(t).normal) {
        for (int k = 0; k < 3; ++k) corner_[k] = (mesh.corner(t, k) - x) * (1 / r);
        h_ = (mesh.plane(t).offset - glm::dot(normal_, x)) / r;
    }

    // Appends the part's arcs to `boundary`.
    PlanePart find(std::vector<Arc>& boundary) {
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
            if (c.leaves) event_[events++] = {{exit_key, c.exit}, k, false};
            any_ = true;
        }
        if (events == 0) {
            if (any_) return {.area = 0.5 * twice_area_};  // all of the triangle is in the ball
            if (square_ == 0) return {};
            for (int k = 0; k < 3; ++k)
                if (cross(corner_[k] - foot_, corner_[(k + 1) % 3] - foot_) <= 0) return {};
            return {pi * square_, 2 * pi, 1};
        }
        // Arcs of the circle, from where the triangle's border leaves the ball to where it comes back.
        for (int i = 0; i < events; ++i) {
            if (event_[i].enters) continue;
            const Event &out = event_[i], &in = event_[(i + 1) % events];
            const double angle = arc(out, in);
            arcs_ += angle;
            twice_area_ += square_ * angle;
            // With the solid on the left the arc runs the other way.
            boundary.push_back({in.piercing.key, out.piercing.key});
        }
        return {0.5 * twice_area_, arcs_, 0};
    }

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

    const ClosedMesh& mesh_;
    int t_;
    Vec3 normal_;
    Vec3 corner_[3];
    double h_;
    Vec3 foot_{0.0};
    double square_ = 0, twice_area_ = 0, arcs_ = 0;
    Event event_[6];
    bool any_ = false;
};

}  // namespace

PlanePart triangle_in_ball(const ClosedMesh& mesh, int t, Vec3 x, double r, std::vector<Arc>& boundary) {
    return TriangleInBall(mesh, t, x, r).find(boundary);
}

}  // namespace deburr
