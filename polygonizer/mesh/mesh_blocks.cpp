#include "polygonizer/mesh/mesh_blocks.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace deburr {
namespace {

// Calls visit(triangles) for each block; the triangles are in increasing order.
template <class Visit>
void halve(const std::vector<Vec3>& middles, std::span<int> triangles, std::size_t most, Visit visit) {
    if (triangles.size() <= most) {
        std::sort(triangles.begin(), triangles.end());
        return visit(triangles);
    }
    Box box;
    for (const int t : triangles) box = hull(box, Box{middles[t], middles[t]});
    const Vec3 size = box.hi - box.lo;
    const int axis = greatest_axis(size);
    const auto half = std::ptrdiff_t(triangles.size() / 2);
    std::nth_element(triangles.begin(), triangles.begin() + half, triangles.end(), [&](int s, int t) {
        return middles[s][axis] != middles[t][axis] ? middles[s][axis] < middles[t][axis] : s < t;
    });
    halve(middles, triangles.first(std::size_t(half)), most, visit);
    halve(middles, triangles.subspan(std::size_t(half)), most, visit);
}

// Numbers a block's elements in the order in which they are first asked for.
class BlockNumbers {
public:
    explicit BlockNumbers(std::size_t count) : of_(count, -1) {}
    int operator()(int index, std::vector<int>& known) {
        if (of_[index] < 0) {
            of_[index] = int(known.size());
            known.push_back(index);
        }
        return of_[index];
    }
    /// Makes the object ready for another block.
    void forget(const std::vector<int>& known) {
        for (const int index : known) of_[index] = -1;
    }

private:
    std::vector<int> of_;
};

}  // namespace

std::vector<MeshBlock> cut_into_blocks(const Mesh& mesh, const std::vector<Origin>& origins, std::size_t most) {
    std::vector<Vec3> middles;
    middles.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        middles.push_back((mesh.positions[t.vertex[0]] + mesh.positions[t.vertex[1]] + mesh.positions[t.vertex[2]]) /
                          3.0);
    std::vector<int> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<MeshBlock> blocks;
    std::vector<int> block_of(mesh.positions.size(), -1);  // of each vertex: the last block that used it
    std::vector<char> is_shared(mesh.positions.size(), false);
    BlockNumbers vertices(mesh.positions.size()), normals(mesh.normals.size());
    halve(middles, all, most, [&](std::span<const int> triangles) {
        MeshBlock& block = blocks.emplace_back();
        for (const int t : triangles) {
            Triangle triangle = mesh.triangles[t];
            for (int& v : triangle.vertex) {
                int& owner = block_of[v];
                if (owner >= 0 && owner != int(blocks.size()) - 1) is_shared[v] = true;
                owner = int(blocks.size()) - 1;
                v = vertices(v, block.vertices);
            }
            for (int& n : triangle.normal) n = normals(n, block.normals);
            block.mesh.triangles.push_back(triangle);
            block.origins.push_back(origins[t]);
        }
        for (const int v : block.vertices) block.mesh.positions.push_back(mesh.positions[v]);
        for (const int n : block.normals) block.mesh.normals.push_back(mesh.normals[n]);
        vertices.forget(block.vertices);
        normals.forget(block.normals);
    });
    for (MeshBlock& block : blocks)
        for (const int v : block.vertices) block.on_border.push_back(is_shared[v]);
    return blocks;
}

std::vector<char> join_blocks(const std::vector<MeshBlock>& blocks, Mesh& mesh, std::vector<Origin>& origins) {
    std::vector<char> on_border(mesh.positions.size(), false);
    mesh.triangles.clear();
    origins.clear();
    std::vector<int> vertices, normals;
    const auto number = [](const std::vector<int>& known, const std::vector<Vec3>& from, std::vector<Vec3>& to,
                           std::vector<int>& numbers) {
        numbers.clear();
        for (std::size_t k = 0; k < known.size(); ++k) {
            numbers.push_back(known[k] >= 0 ? known[k] : int(to.size()));
            if (known[k] < 0) to.push_back(from[k]);
        }
    };
    for (const MeshBlock& block : blocks) {
        number(block.vertices, block.mesh.positions, mesh.positions, vertices);
        number(block.normals, block.mesh.normals, mesh.normals, normals);
        on_border.resize(mesh.positions.size(), false);
        for (std::size_t k = 0; k < vertices.size(); ++k)
            if (block.on_border[k]) on_border[vertices[k]] = true;
        for (Triangle triangle : block.mesh.triangles) {
            for (int& v : triangle.vertex) v = vertices[v];
            for (int& n : triangle.normal) n = normals[n];
            mesh.triangles.push_back(triangle);
        }
        origins.insert(origins.end(), block.origins.begin(), block.origins.end());
    }
    return on_border;
}

}  // namespace deburr
