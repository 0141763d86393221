#include "polygonizer/mesh/simplify_borders.hpp"

namespace deburr {
namespace {

class Thinning {
public:
    Thinning(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double farthest)
        : facets_(mesh, origins), judge_(judge), farthest_(farthest) {
        for (std::size_t f = 0; f < facets_.size(); ++f) normals_.push_back(normal_of(int(f)));
    }

    std::size_t run() {
        std::size_t gone = 0;
        for (int v = 0; v < facets_.vertices(); ++v) gone += straight(v) && collapse(v);
        if (gone > 0) facets_.finish();
        return gone;
    }

private:
    // The normal of a facet whose corners all have one; else 0.
    Vec3 normal_of(int f) const {
        const auto& n = facets_.at(f).triangle.normal;
        const Vec3 a = facets_.normal(n[0]);
        for (const std::size_t k : {1, 2})
            if (n[k] != n[0] && glm::length(facets_.normal(n[k]) - a) >= same_normal) return Vec3(0.0);
        return a;
    }
    bool flat(int f) const { return normals_[f] != Vec3(0.0); }

    // Whether v is on the border of one flat face, in line with its two neighbours on that border, which become rim_.
    bool straight(int v) {
        Vec3 plane(0.0);
        bool bent = false;
        for (const int f : facets_.around(v)) {
            if (!flat(f)) {
                bent = true;
                continue;
            }
            const Vec3 n = normals_[f];
            if (plane != Vec3(0.0) && glm::length(n - plane) >= same_normal) return false;
            plane = n;
        }
        if (plane == Vec3(0.0) || !bent) return false;
        std::size_t count = 0;
        for (const int f : facets_.around(v)) {
            if (!flat(f)) continue;
            const Triangle& t = facets_.at(f).triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = t.vertex[k], b = t.vertex[(k + 1) % 3];
                if ((a != v && b != v) || flat(facets_.across(a, b))) continue;
                if (count == 2) return false;
                rim_[count++] = a == v ? b : a;
            }
        }
        if (count != 2) return false;
        const Vec3 p = glm::normalize(facets_.position(rim_[0]) - facets_.position(v));
        const Vec3 q = glm::normalize(facets_.position(rim_[1]) - facets_.position(v));
        return !(glm::length(p + q) > 1e-9);
    }

    bool collapse(int v) {
        for (const int to : rim_) {
            const auto change = facets_.collapse(v, to);
            if (!change || !accept(*change)) continue;
            for (const int f : facets_.apply(*change)) normals_[f] = normal_of(f);
            return true;
        }
        return false;
    }

    bool accept(const Change& change) const {
        for (const Facet& f : change.in) {
            const FacetShape s = judge_.shape(facets_, f, upright_after_collapse);
            if (s.cosine < upright_after_collapse || s.distance > farthest_) return false;
        }
        return true;
    }

    Facets facets_;
    const FacetJudge& judge_;
    double farthest_;
    std::vector<Vec3> normals_;  // by facet: its normal if it is flat, else 0
    int rim_[2];
};

}  // namespace

std::size_t simplify_borders(Mesh& mesh, std::vector<Origin>& origins, const FacetJudge& judge, double farthest) {
    if (mesh.triangles.empty()) return 0;
    return Thinning(mesh, origins, judge, farthest).run();
}

}  // namespace deburr
