#include "raytracer/mesh/split_distant_triangles.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace deburr {
namespace {

class Splitter {
public:
    Splitter(Mesh& mesh, const Box& near)
        : mesh_(mesh), middle_(0.5 * (near.lo + near.hi)), size_(glm::length(near.hi - near.lo)) {
        const Box all = bounding_box(mesh);
        if (!all.empty()) size_ = std::max(size_, min_share * glm::length(all.hi - all.lo));
    }

    bool round() {
        middles_.clear();
        for (const Triangle& t : mesh_.triangles)
            if (!along_axes(t))
                for (std::size_t k = 0; k < 3; ++k) split_if_long(t.vertex[k], t.vertex[(k + 1) % 3]);
        if (middles_.empty()) return false;
        std::vector<Triangle> out;
        for (const Triangle& t : mesh_.triangles) {
            std::array<int, 3> m;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto at = middles_.find(std::minmax(t.vertex[k], t.vertex[(k + 1) % 3]));
                m[k] = at == middles_.end() ? -1 : at->second;
            }
            halve(t, m, out);
        }
        mesh_.triangles = std::move(out);
        return true;
    }

private:
    static constexpr double min_share = 1e-7;  // of the mesh's size, the limit of single precision

    bool along_axes(const Triangle& t) const {
        const auto at = [&](std::size_t i) { return mesh_.positions[t.vertex[i]]; };
        for (int k = 0; k < 3; ++k)
            if (at(0)[k] == at(1)[k] && at(0)[k] == at(2)[k]) return true;
        return false;
    }

    void split_if_long(int a, int b) {
        const Vec3 xa = mesh_.positions[a], xb = mesh_.positions[b];
        if (glm::distance(xa, xb) <= size_ + distance_to_segment(middle_, xa, xb)) return;
        if (middles_.try_emplace(std::minmax(a, b), int(mesh_.positions.size())).second)
            mesh_.positions.push_back(0.5 * (xa + xb));
    }

    int middle_normal(int a, int b) {
        if (a == b) return a;
        const Vec3 sum = mesh_.normals[a] + mesh_.normals[b];
        if (glm::length(sum) <= 0) return a;
        mesh_.normals.push_back(glm::normalize(sum));
        return int(mesh_.normals.size()) - 1;
    }

    // Halves the triangle at one of its edges, then the halves at the others. `m` holds the middle of each edge, or −1.
    void halve(const Triangle& t, const std::array<int, 3>& m, std::vector<Triangle>& out) {
        std::size_t a = 0;
        while (a < 3 && m[a] < 0) ++a;
        if (a == 3) return out.push_back(t);
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        const int normal = middle_normal(t.normal[a], t.normal[b]);
        Triangle before = t, beyond = t;
        before.vertex[b] = beyond.vertex[a] = m[a];
        before.normal[b] = beyond.normal[a] = normal;
        std::array<int, 3> of_before{-1, -1, -1}, of_beyond{-1, -1, -1};
        of_before[c] = m[c];
        of_beyond[b] = m[b];
        halve(before, of_before, out);
        halve(beyond, of_beyond, out);
    }

    Mesh& mesh_;
    Vec3 middle_;
    double size_;
    std::map<std::pair<int, int>, int> middles_;
};

}  // namespace

Mesh split_distant_triangles(Mesh mesh, const Box& near) {
    if (near.empty() || !near.finite()) return mesh;
    Splitter splitter(mesh, near);
    while (splitter.round()) {
    }
    return mesh;
}

}  // namespace deburr
