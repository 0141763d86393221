#include "polygonizer/mesh/decimate.hpp"

#include <algorithm>

namespace deburr {
namespace {

constexpr double same_normal = 1e-6;
// Cosine between two facets' normals at a vertex below which their common edge is a crease.
constexpr double crease = 0.9;
// Cosine between a facet and its surface that a collapse must leave.
constexpr double upright = 0.8;
// Height over longest side: facets that are curved get no thinner than this, unless they were.
constexpr double slender = 0.02;
// Facets around one vertex, beyond which a collapse makes it no better to work with.
constexpr std::size_t max_fan = 20;

double distance_to_triangle(Vec3 x, const Vec3 (&corner)[3]) {
    const Vec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double size = glm::length(normal);
    bool within = size > 0;
    for (int k = 0; k < 3 && within; ++k)
        within = glm::dot(glm::cross(corner[(k + 1) % 3] - corner[k], x - corner[k]), normal) >= 0;
    if (within) return std::abs(glm::dot(normal, x - corner[0])) / size;
    return std::min({distance_to_segment(x, corner[0], corner[1]), distance_to_segment(x, corner[1], corner[2]),
                     distance_to_segment(x, corner[2], corner[0])});
}

class Decimation {
public:
    Decimation(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance, StopFlag stop)
        : facets_(mesh, origins), judge_(judge), tolerance_(tolerance), stop_(stop) {
        for (std::size_t f = 0; f < facets_.size(); ++f) flat_normals_.push_back(flat_normal(facets_.at(int(f))));
    }

    std::size_t run() {
        // What costs little goes first, so that what is left can bear more.
        std::size_t gone = 0;
        for (const double share : {0.05, 0.3, 1.0}) {
            constexpr int max_rounds = 6;
            for (int round = 0; round < max_rounds; ++round) {
                const std::size_t now = pass(share * tolerance_);
                gone += now;
                if (100 * now < std::size_t(facets_.vertices())) break;
            }
        }
        if (gone > 0) facets_.finish();
        return gone;
    }

private:
    struct Candidate {
        double error;
        int to;
    };

    std::size_t pass(double tolerance) {
        std::size_t gone = 0;
        for (int v = 0; v < facets_.vertices(); ++v) {
            if (v % 1024 == 0) throw_if_stopped(stop_);
            if (facets_.around(v).size() > 0 && find_candidates(v, tolerance)) gone += collapse(v, tolerance);
        }
        return gone;
    }

    // The normal of a facet that is part of a plane, or 0.
    Vec3 flat_normal(const Facet& f) const {
        const auto& n = f.triangle.normal;
        const Vec3 a = facets_.normal(n[0]);
        for (const std::size_t k : {1, 2})
            if (n[k] != n[0] && glm::length(facets_.normal(n[k]) - a) >= same_normal) return Vec3(0.0);
        return a;
    }

    Vec3 normal_at(int f, int v) const {
        return facets_.normal(facets_.at(f).triangle.normal[std::size_t(facets_.place(f, v))]);
    }

    // Whether the edge from v to u, of facets f and g, must stay a line of edges: a crease, a border of materials, the
    // rim of a flat face. Curved facets would spread over a flat face else, tilted by less than the tolerance.
    bool is_line(int f, int g, int v) const {
        if ((flat_normals_[std::size_t(f)] == Vec3(0.0)) != (flat_normals_[std::size_t(g)] == Vec3(0.0))) return true;
        return facets_.at(f).triangle.material != facets_.at(g).triangle.material ||
               glm::dot(normal_at(f, v), normal_at(g, v)) < crease;
    }

    // Where v may go, the nearest to its facets first; false if it must stay.
    bool find_candidates(int v, double tolerance) {
        candidates_.clear();
        planes_.clear();
        line_ends_.clear();
        const auto& fan = facets_.around(v);
        for (const int f : fan) {
            const Vec3 n = flat_normals_[std::size_t(f)];
            if (n != Vec3(0.0) &&
                std::none_of(planes_.begin(), planes_.end(), [&](Vec3 p) { return glm::length(p - n) < same_normal; }))
                planes_.push_back(n);
        }
        if (planes_.size() > 2) return false;
        for (const int f : fan) {
            const int u = facets_.at(f).triangle.vertex[std::size_t((facets_.place(f, v) + 1) % 3)];
            const int g = facets_.across(v, u) == f ? facets_.across(u, v) : facets_.across(v, u);
            if (g < 0) return false;
            const bool line = is_line(f, g, v);
            if (line) line_ends_.push_back(u);
            candidates_.push_back({0, u});
        }
        if (!line_ends_.empty()) {
            if (line_ends_.size() != 2) return false;
            std::erase_if(candidates_,
                          [&](const Candidate& c) { return c.to != line_ends_[0] && c.to != line_ends_[1]; });
        }
        const Vec3 x = facets_.position(v);
        std::erase_if(candidates_, [&](Candidate& c) {
            const Vec3 d = facets_.position(c.to) - x;
            for (const Vec3& n : planes_)
                if (std::abs(glm::dot(n, d)) > 1e-9 * judge_.size()) return true;
            c.error = error(v, c.to, x);
            return c.error > tolerance;
        });
        std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
            return a.error != b.error ? a.error < b.error : a.to < b.to;
        });
        return !candidates_.empty();
    }

    // How far v is from what its facets would be; large, too, where these turn over.
    double error(int v, int to, Vec3 x) const {
        double least = infinity;
        for (const int f : facets_.around(v)) {
            auto vertex = facets_.at(f).triangle.vertex;
            if (std::find(vertex.begin(), vertex.end(), to) != vertex.end()) continue;
            const Vec3 before = facets_.area_vector(facets_.at(f).triangle);
            vertex[std::size_t(facets_.place(f, v))] = to;
            const Vec3 corner[3] = {facets_.position(vertex[0]), facets_.position(vertex[1]),
                                    facets_.position(vertex[2])};
            const Vec3 after = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            if (glm::dot(before, after) <= 0.2 * glm::length(before) * glm::length(after)) return infinity;
            least = std::min(least, distance_to_triangle(x, corner));
        }
        return least;
    }

    bool collapse(int v, double tolerance) {
        constexpr std::size_t max_tries = 30;
        for (std::size_t k = 0; k < std::min(max_tries, candidates_.size()); ++k) {
            const int to = candidates_[k].to;
            const auto change = facets_.collapse(v, to);
            if (!change || facets_.around(to).size() + change->in.size() > 2 + max_fan + 2 * planes_.size() * max_fan)
                continue;
            if (!accept(*change, v, to, tolerance)) continue;
            for (const int f : facets_.apply(*change)) {
                flat_normals_.resize(std::max(flat_normals_.size(), std::size_t(f) + 1));
                flat_normals_[std::size_t(f)] = flat_normal(facets_.at(f));
            }
            return true;
        }
        return false;
    }

    double slenderness(const Triangle& t) const {
        double longest2 = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 d = facets_.position(t.vertex[k]) - facets_.position(t.vertex[(k + 1) % 3]);
            longest2 = std::max(longest2, glm::dot(d, d));
        }
        return longest2 > 0 ? glm::length(facets_.area_vector(t)) / longest2 : 0;
    }

    // Whether points all over the triangle are within the tolerance: in its inside, and on its edges from `to`, for the
    // one opposite did not change. Its middle is judged with its shape.
    bool is_near(const Triangle& t, int to, double tolerance) const {
        Vec3 x[3];
        for (std::size_t k = 0; k < 3; ++k) x[k] = facets_.position(t.vertex[k]);
        const auto near = [&](double a, double b, double c) {
            const double d = judge_.solid().at(a * x[0] + b * x[1] + c * x[2]).distance;
            return !std::isfinite(d) || std::abs(d) <= tolerance;
        };
        constexpr double most = 2.0 / 3, rest = 1.0 / 6;
        if (!near(most, rest, rest) || !near(rest, most, rest) || !near(rest, rest, most)) return false;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3;
            if (t.vertex[k] != to && t.vertex[l] != to) continue;
            for (const double share : {0.25, 0.5, 0.75}) {
                double weight[3] = {0, 0, 0};
                weight[k] = 1 - share;
                weight[l] = share;
                if (!near(weight[0], weight[1], weight[2])) return false;
            }
        }
        return true;
    }

    bool accept(const Change& change, int v, int to, double tolerance) const {
        double thinnest = slender;
        for (const int f : change.out)
            if (flat_normals_[std::size_t(f)] == Vec3(0.0))
                thinnest = std::min(thinnest, slenderness(facets_.at(f).triangle));
        for (const Facet& f : change.in) {
            if (flat_normal(f) == Vec3(0.0) && slenderness(f.triangle) < thinnest) return false;
            const FacetShape s = judge_.shape(facets_, f, upright);
            if (s.cosine < upright || s.distance > tolerance) return false;
            if (!is_near(f.triangle, to, tolerance)) return false;
        }
        return v != to;
    }

    Facets facets_;
    const FacetJudge& judge_;
    double tolerance_;
    StopFlag stop_;
    std::vector<Vec3> flat_normals_;  // of facets; 0: curved
    // Of the vertex that is looked at.
    std::vector<Candidate> candidates_;
    std::vector<Vec3> planes_;
    std::vector<int> line_ends_;
};

}  // namespace

std::size_t decimate(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double tolerance,
                     StopFlag stop) {
    if (mesh.triangles.empty()) return 0;
    return Decimation(mesh, origins, judge, tolerance, stop).run();
}

}  // namespace deburr
