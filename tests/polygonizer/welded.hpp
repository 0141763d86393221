// A mesh as a reader of STL files sees it: vertices at the same position in single precision are one vertex.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>

#include "polygonizer/mesh/mesh.hpp"

namespace deburr {

/// Collects a mesh whose vertices are unique by position.
class Welder {
public:
    int vertex(std::array<float, 3> x) {
        for (float& c : x) c += 0.0f;  // −0 is 0
        const auto [at, fresh] = known_.try_emplace(x, int(mesh.positions.size()));
        if (fresh) mesh.positions.push_back(Vec3(x[0], x[1], x[2]));
        return at->second;
    }
    Mesh mesh;

private:
    std::map<std::array<float, 3>, int> known_;
};

inline Mesh welded(const Mesh& mesh) {
    Welder w;
    for (const Triangle& t : mesh.triangles) {
        Triangle joined = t;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 x = mesh.positions[t.vertex[k]];
            joined.vertex[k] = w.vertex({float(x.x), float(x.y), float(x.z)});
        }
        w.mesh.triangles.push_back(joined);
    }
    return w.mesh;
}

/// The welded mesh of a binary STL file, given as its bytes.
inline Mesh welded_stl(const std::string& bytes) {
    Welder w;
    for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::array<float, 3> x;
            std::memcpy(x.data(), bytes.data() + at + 12 * (k + 1), sizeof x);
            t.vertex[k] = w.vertex(x);
        }
        w.mesh.triangles.push_back(t);
    }
    return w.mesh;
}

}  // namespace deburr
