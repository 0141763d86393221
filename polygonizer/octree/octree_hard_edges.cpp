#include "polygonizer/octree/octree_hard_edges.hpp"

#include <algorithm>

namespace deburr {
namespace {

// The greatest turn of a hard edge that is as fine as the cells: 12°, as in a circle of 30 edges.
constexpr double wanted_turn = 0.21;
// The least s(P), in cells.
constexpr double min_length = 0.25;
// Printed differently: "√2·|PQ| > [s(P) + s(Q)]/2" divides edges that are shorter than wanted. With
// √2 on the other side, halves are as much shorter than wanted as the whole was longer.
constexpr double too_long = 1.4142135623730951;
// A point S that has to move farther than this, relative to the edge, is not on the hard edge.
constexpr double farthest_move = 0.3;
// A length comes near to the wanted one in a few halvings, or never.
constexpr int max_halvings = 8;
// An end of an edge that is nearer to the hard edge than this, relative to the edge, moves there if it can.
constexpr double near_end = 1.2;
// The least cosine of the angle by which a triangle may turn where its point moves; chamfers turn by 45°.
constexpr double min_turn_cosine = 0.3;
// The least cosine of the angle to the face that all points of the triangle are on, if there is one; it applies instead
// of min_turn_cosine.
constexpr double min_face_cosine = 0.5;
// The least ratio of height to longest side of a triangle that is made.
constexpr double min_height = 1e-3;

// The triangles around points.
class Fans {
public:
    explicit Fans(const PointMesh& mesh) : first_(mesh.points.size() + 1, 0) {
        for (const TriangleVertices& t : mesh.triangles)
            for (const int v : t) ++first_[std::size_t(v) + 1];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        triangles_.resize(3 * mesh.triangles.size());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (const int v : mesh.triangles[t]) triangles_[next[v]++] = int(t);
    }
    const int* begin(int v) const { return triangles_.data() + first_[v]; }
    const int* end(int v) const { return triangles_.data() + first_[std::size_t(v) + 1]; }

private:
    std::vector<std::size_t> first_;
    std::vector<int> triangles_;
};

/// One round of moving points to hard edges.
class Following {
public:
    Following(PointMesh& mesh, const CellTree& tree, double hard_cosine)
        : mesh_(mesh), tree_(tree), hard_cosine_(hard_cosine), fans_(mesh), touched_(mesh.triangles.size(), false) {}

    std::size_t edges() {
        std::size_t count = 0;
        for (const PointMesh::Edge& e : mesh_.edges([&](int p, int q) { return bends(p, q); })) count += follow(e);
        return count;
    }

    // Divides triangles whose points are on three hard edges and have no face in common: they cut off a corner.
    std::size_t corners() {
        std::size_t count = 0;
        const std::size_t before = mesh_.triangles.size();
        for (std::size_t t = 0; t < before; ++t) {
            const TriangleVertices corners = mesh_.triangles[t];
            if (!mesh_.point(corners[0]).hard() || !mesh_.point(corners[1]).hard() || !mesh_.point(corners[2]).hard())
                continue;
            if (share_face(corners)) continue;
            const std::vector<Vec3> points{mesh_.position(corners[0]), mesh_.position(corners[1]),
                                           mesh_.position(corners[2])};
            const auto point = cut_off_point(*tree_.solid(inflated(mesh_.box(corners), tree_.edge())), points,
                                             mesh_.middle(corners), hard_cosine_);
            if (!point) continue;
            mesh_.divide(int(t), *point);
            ++count;
        }
        return count;
    }

private:
    /// Whether an edge passes from one face to another beside the hard edge: its points have no face in common.
    bool bends(int p, int q) const {
        const SurfacePoint &a = mesh_.point(p), &b = mesh_.point(q);
        if (a.faces.size() == 1 && b.faces.size() == 1)
            return glm::dot(a.faces[0].normal, b.faces[0].normal) < hard_cosine_;
        for (const Face& f : a.faces)
            for (const Face& g : b.faces)
                if (glm::dot(f.normal, g.normal) >= hard_cosine_) return false;
        return true;
    }

    // Whether accept(normal) is true for one of the faces that all points of the triangle are on.
    template <class Accept>
    bool any_face(const TriangleVertices& t, Accept accept) const {
        for (const Face& f : mesh_.point(t[0]).faces) {
            const auto alike = [&](const Face& g) { return glm::dot(f.normal, g.normal) >= hard_cosine_; };
            const auto &second = mesh_.point(t[1]).faces, &third = mesh_.point(t[2]).faces;
            if (std::any_of(second.begin(), second.end(), alike) && std::any_of(third.begin(), third.end(), alike) &&
                accept(f.normal))
                return true;
        }
        return false;
    }
    bool share_face(const TriangleVertices& t) const {
        return any_face(t, [](Vec3) { return true; });
    }

    // Whether a triangle may become this one, given its former area vector.
    bool may_become(const TriangleVertices& t, Vec3 before) const {
        const Vec3 now = mesh_.area_vector(t);
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, glm::length(mesh_.position(t[k]) - mesh_.position(t[(k + 1) % 3])));
        const double size = glm::length(now);
        if (size < min_height * longest * longest) return false;
        if (share_face(t)) return any_face(t, [&](Vec3 n) { return glm::dot(now, n) >= min_face_cosine * size; });
        return glm::dot(now, before) >= min_turn_cosine * size * glm::length(before);
    }

    bool follow(const PointMesh::Edge& e) {
        if (touched_[e.left] || touched_[e.right]) return false;
        const Vec3 p = mesh_.position(e.p), q = mesh_.position(e.q);
        const double length = glm::length(p - q);
        const auto solid = tree_.solid(inflated(hull({p, p}, {q, q}), length));
        const auto from_p = cut_off_point(*solid, {p, q}, p, hard_cosine_),
                   from_q = cut_off_point(*solid, {p, q}, q, hard_cosine_);
        const double to_p = from_p ? glm::length(from_p->position - p) : infinity;
        const double to_q = from_q ? glm::length(from_q->position - q) : infinity;
        for (const bool first : {to_p <= to_q, to_p > to_q})
            if ((first ? to_p : to_q) < near_end * length && move(first ? e.p : e.q, first ? *from_p : *from_q))
                return true;
        const auto point = cut_off_point(*solid, {p, q}, 0.5 * (p + q), hard_cosine_);
        if (!point) return false;
        std::array<std::pair<TriangleVertices, Vec3>, 2> before;
        for (std::size_t k = 0; k < 2; ++k) {
            const TriangleVertices& t = mesh_.triangles[k ? e.right : e.left];
            before[k] = {t, mesh_.area_vector(t)};
        }
        const std::size_t points = mesh_.points.size(), triangles = mesh_.triangles.size();
        mesh_.divide(e, *point);
        bool good = true;
        for (std::size_t k = 0; k < 2; ++k)
            good &= may_become(mesh_.triangles[k ? e.right : e.left], before[k].second) &&
                    may_become(mesh_.triangles[triangles + k], before[k].second);
        if (!good) {
            mesh_.points.resize(points);
            mesh_.triangles.resize(triangles);
            mesh_.triangles[e.left] = before[0].first;
            mesh_.triangles[e.right] = before[1].first;
            return false;
        }
        for (const int v : {e.p, e.q}) touch(v);
        return true;
    }

    void touch(int v) {
        for (const int* t = fans_.begin(v); t != fans_.end(v); ++t) touched_[*t] = true;
    }

    // Whether a point is a corner of all faces of the other point and of more.
    bool lies_on_all(const SurfacePoint& corner, const SurfacePoint& other) const {
        return corner.faces.size() > other.faces.size() &&
               std::all_of(other.faces.begin(), other.faces.end(), [&](const Face& f) {
                   return std::any_of(corner.faces.begin(), corner.faces.end(),
                                      [&](const Face& g) { return glm::dot(f.normal, g.normal) >= hard_cosine_; });
               });
    }

    bool move(int v, const SurfacePoint& to) {
        SurfacePoint& point = mesh_.points[v];
        if (point.hard() && !lies_on_all(to, point)) return false;
        const SurfacePoint was = point;
        std::vector<Vec3> before;
        for (const int* t = fans_.begin(v); t != fans_.end(v); ++t) {
            if (touched_[*t]) return false;
            before.push_back(mesh_.area_vector(mesh_.triangles[*t]));
        }
        point = to;
        std::size_t k = 0;
        for (const int* t = fans_.begin(v); t != fans_.end(v); ++t, ++k)
            if (!may_become(mesh_.triangles[*t], before[k])) {
                point = was;
                return false;
            }
        touch(v);
        return true;
    }

    PointMesh& mesh_;
    const CellTree& tree_;
    double hard_cosine_;
    Fans fans_;
    std::vector<char> touched_;  // triangles that this round has changed
};

/// Division of hard edges to the wanted length.
class Division {
public:
    Division(PointMesh& mesh, const CellTree& tree, double hard_cosine)
        : mesh_(mesh), tree_(tree), hard_cosine_(hard_cosine) {}

    std::size_t round() {
        const std::vector<PointMesh::Edge> edges = hard_edges();
        wanted_lengths(edges);
        std::vector<char> touched(mesh_.triangles.size(), false);
        std::size_t count = 0;
        for (const PointMesh::Edge& e : edges) {
            if (touched[e.left] || touched[e.right] || !divide(e)) continue;
            touched[e.left] = touched[e.right] = true;
            ++count;
        }
        return count;
    }

private:
    std::vector<PointMesh::Edge> hard_edges() const {
        auto edges = mesh_.edges([&](int p, int q) { return mesh_.point(p).hard() && mesh_.point(q).hard(); });
        std::erase_if(edges, [&](const PointMesh::Edge& e) {
            const Vec3 m = mesh_.area_vector(mesh_.triangles[e.left]);
            const Vec3 n = mesh_.area_vector(mesh_.triangles[e.right]);
            return glm::dot(m, n) >= hard_cosine_ * glm::length(m) * glm::length(n);
        });
        return edges;
    }

    void wanted_lengths(const std::vector<PointMesh::Edge>& edges) {
        std::vector<std::array<int, 2>> other(mesh_.points.size(), {-1, -1});
        std::vector<std::size_t> count(mesh_.points.size(), 0);
        const auto note = [&](int v, int w) {
            std::size_t& n = count[v];
            if (n < 2) other[v][n] = w;
            ++n;
        };
        for (const PointMesh::Edge& e : edges) {
            note(e.p, e.q);
            note(e.q, e.p);
        }
        wanted_.assign(mesh_.points.size(), tree_.edge());
        for (std::size_t v = 0; v < wanted_.size(); ++v) {
            if (count[v] != 2) continue;
            const Vec3 in = mesh_.position(int(v)) - mesh_.position(other[v][0]);
            const Vec3 out = mesh_.position(other[v][1]) - mesh_.position(int(v));
            const double turn = std::atan2(glm::length(glm::cross(in, out)), glm::dot(in, out));
            if (turn > wanted_turn) wanted_[v] *= std::max(min_length, wanted_turn / turn);
        }
    }

    bool divide(const PointMesh::Edge& e) {
        const Vec3 p = mesh_.position(e.p), q = mesh_.position(e.q);
        const double sp = wanted_[e.p], sq = wanted_[e.q], length = glm::length(p - q);
        if (length <= too_long * 0.5 * (sp + sq)) return false;
        const TriangleVertices &left = mesh_.triangles[e.left], &right = mesh_.triangles[e.right];
        const Vec3 s = (sp * q + sq * p) / (sp + sq);
        const auto solid = tree_.solid(inflated(hull(mesh_.box(left), mesh_.box(right)), length));
        const auto point = hard_edge_point(*solid, s, p, q, farthest_move * length, hard_cosine_);
        if (!point) return false;
        mesh_.divide(e, *point);
        return true;
    }

    PointMesh& mesh_;
    const CellTree& tree_;
    double hard_cosine_;
    std::vector<double> wanted_;
};

}  // namespace

std::size_t follow_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine) {
    std::size_t all = 0;
    for (int round = 0; round < max_halvings; ++round) {
        const std::size_t now = Following(mesh, tree, hard_cosine).edges();
        all += now;
        if (now == 0) break;
    }
    return all + Following(mesh, tree, hard_cosine).corners();
}

std::size_t divide_hard_edges(PointMesh& mesh, const CellTree& tree, double hard_cosine) {
    Division division(mesh, tree, hard_cosine);
    std::size_t all = 0;
    for (int round = 0; round < max_halvings; ++round) {
        const std::size_t now = division.round();
        all += now;
        if (now == 0) break;
    }
    return all;
}

}  // namespace deburr
