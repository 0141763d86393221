// The part of a triangle in a ball: its area, and its arcs on the sphere [docs/design.md, Closed meshes].
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "bounds/closed_mesh.hpp"

namespace deburr {

/// A point where an edge pierces the sphere. Both triangles of the edge have the same key for it.
struct Piercing {
    int key;
    Vec3 at;  // from the ball's centre, in radii
};

/// The part of the edge from a to b in the unit ball around the origin: where it enters and leaves. It is computed with
/// the vertices in one order whichever triangle asks, so that both triangles get the same bits.
struct Chord {
    bool inside[2] = {false, false};  // whether each end is in the ball
    bool enters = false, leaves = false;
    Vec3 entry{0.0}, exit{0.0};
};

inline Chord chord_of(Vec3 a, Vec3 b) {
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

/// An arc of a plane's circle on the sphere, with the solid on its left, from one piercing to another.
struct Arc {
    int from, to;  // keys
};

/// The part of a triangle or of a face in a ball: its area in squared radii, the sum of the angles of its arcs on the
/// sphere, and the number of whole circles among them.
struct PlanePart {
    double area = 0, arcs = 0;
    int circles = 0;
};

/// The part of triangle t in the ball of radius r > 0 around x. Its arcs are appended to `boundary`.
PlanePart triangle_in_ball(const ClosedMesh& mesh, int t, Vec3 x, double r, std::vector<Arc>& boundary);

}  // namespace deburr
