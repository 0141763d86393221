#include "polygonizer/marching_cubes/marching_cubes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>

#include "polygonizer/mesh/separate_touching.hpp"
#include "polygonizer/mesh/surface_distance.hpp"

namespace deburr {
namespace {

// Corner k of a cube is at (k & 1, k >> 1 & 1, k >> 2 & 1). Faces run counter-clockwise seen from outside.
constexpr int face_corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

// Signed distances at the corners of a grid, sampled block by block, so that a block evaluates only what matters in it.
class Grid {
public:
    Grid(const SignedDistance& solid, const Box& box, double side, CancelFlag cancel, WorkProgress* progress)
        : side_(side) {
        for (int k = 0; k < 3; ++k) {
            // The outermost corners lie beyond the box and count as outside.
            n_[k] = std::max(1, int(std::ceil((box.hi[k] - box.lo[k]) / side))) + 3;
            origin_[k] = 0.5 * (box.lo[k] + box.hi[k]) - 0.5 * side * (n_[k] - 1);
        }
        blocks_x_ = (n_[0] + block - 1) / block;
        blocks_y_ = (n_[1] + block - 1) / block;
        blocks_z_ = (n_[2] + block - 1) / block;
        blocks_.resize(std::size_t(blocks_x_) * std::size_t(blocks_y_) * std::size_t(blocks_z_));
        if (progress) progress->begin(0.6);
        for (int z = 0; z < blocks_z_; ++z)
            for (int y = 0; y < blocks_y_; ++y) {
                for (int x = 0; x < blocks_x_; ++x) {
                    throw_if_cancelled(cancel);
                    sample(solid, x, y, z);
                }
                if (progress) progress->advance(1.0 / blocks_y_ / blocks_z_);
            }
    }

    int size(int axis) const { return n_[axis]; }
    Vec3 corner(int x, int y, int z) const { return origin_ + side_ * Vec3(x, y, z); }

    /// The signed distance at a corner, > 0 inside.
    double value(int x, int y, int z) const {
        if (x == 0 || y == 0 || z == 0 || x + 1 == n_[0] || y + 1 == n_[1] || z + 1 == n_[2]) return -infinity;
        const Block& b = block_at(x, y, z);
        if (b.values.empty()) return b.all;
        return b.values[((z % block) * block + y % block) * block + x % block];
    }
    /// Whether cubes whose lowest corner is in this block may hold a part of the surface.
    bool is_open(int bx, int by, int bz) const {
        const double first = blocks_[index(bx, by, bz)].all;
        for (int k = 0; k < 8; ++k) {
            const int x = std::min(bx + (k & 1), blocks_x_ - 1), y = std::min(by + (k >> 1 & 1), blocks_y_ - 1),
                      z = std::min(bz + (k >> 2), blocks_z_ - 1);
            const Block& b = blocks_[index(x, y, z)];
            if (!b.values.empty() || b.all != first) return true;
        }
        // A block inside may border on the outermost corners.
        return first > 0 &&
               (bx == 0 || by == 0 || bz == 0 || bx + 2 >= blocks_x_ || by + 2 >= blocks_y_ || bz + 2 >= blocks_z_);
    }
    int blocks(int axis) const { return axis == 0 ? blocks_x_ : axis == 1 ? blocks_y_ : blocks_z_; }
    static constexpr int block = 8;

private:
    struct Block {
        double all = 0;  // value at every corner if `values` is empty
        std::vector<double> values;
    };
    std::size_t index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(blocks_y_) + std::size_t(y)) * std::size_t(blocks_x_) + std::size_t(x);
    }
    const Block& block_at(int x, int y, int z) const { return blocks_[index(x / block, y / block, z / block)]; }

    void sample(const SignedDistance& solid, int bx, int by, int bz) {
        Block& b = blocks_[index(bx, by, bz)];
        const Box box{corner(bx * block, by * block, bz * block),
                      corner(bx * block + block - 1, by * block + block - 1, bz * block + block - 1)};
        b.all = solid.constant_side(box);
        if (b.all != 0) return;
        const SignedDistance local = solid.within(box);
        for (int z = 0; z < block; ++z)
            for (int y = 0; y < block; ++y)
                for (int x = 0; x < block; ++x)
                    b.values.push_back(local.at(corner(bx * block + x, by * block + y, bz * block + z)).distance);
    }

    double side_;
    int n_[3];
    Vec3 origin_;
    int blocks_x_, blocks_y_, blocks_z_;
    std::vector<Block> blocks_;
};

/// One run of marching cubes.
class March {
public:
    March(const SolidTree& solid, const Box& box, double side, CancelFlag cancel, WorkProgress* progress)
        : field_(solid, inflated(box, 2 * side)),
          box_(box),
          grid_(SignedDistance(solid), box, side, cancel, progress),
          side_(side),
          cancel_(cancel),
          progress_(progress) {}

    Mesh run() {
        constexpr int n = Grid::block;
        if (progress_) progress_->begin(0.9);
        for (int bz = 0; bz < grid_.blocks(2); ++bz)
            for (int by = 0; by < grid_.blocks(1); ++by) {
                if (progress_) progress_->advance(1.0 / grid_.blocks(1) / grid_.blocks(2));
                for (int bx = 0; bx < grid_.blocks(0); ++bx) {
                    throw_if_cancelled(cancel_);
                    if (!grid_.is_open(bx, by, bz)) continue;
                    for (int z = bz * n; z < std::min((bz + 1) * n, grid_.size(2) - 1); ++z)
                        for (int y = by * n; y < std::min((by + 1) * n, grid_.size(1) - 1); ++y)
                            for (int x = bx * n; x < std::min((bx + 1) * n, grid_.size(0) - 1); ++x) cube(x, y, z);
                }
            }
        mesh_.polygons = mesh_.triangles.size();
        return std::move(mesh_);
    }

private:
    // Number of a grid edge, given by its lower corner and axis.
    std::size_t edge_key(int x, int y, int z, int axis) const {
        return ((std::size_t(z) * std::size_t(grid_.size(1)) + std::size_t(y)) * std::size_t(grid_.size(0)) +
                std::size_t(x)) *
                   3 +
               std::size_t(axis);
    }

    /// The vertex on the edge from corner a to corner b of the cube at (x, y, z).
    int vertex_on(int x, int y, int z, int a, int b) {
        if (a > b) std::swap(a, b);
        const int axis = (b ^ a) == 1 ? 0 : (b ^ a) == 2 ? 1 : 2;
        const int ax = x + (a & 1), ay = y + (a >> 1 & 1), az = z + (a >> 2);
        const auto [it, is_new] = on_edge_.try_emplace(edge_key(ax, ay, az, axis), int(mesh_.positions.size()));
        if (!is_new) return it->second;
        Vec3 lo = grid_.corner(ax, ay, az), hi = lo;
        hi[axis] += side_;
        // The root if it is in the box; on the box's wall where the solid leaves it.
        const bool low_in = grid_.value(ax, ay, az) > 0;
        const auto [t0, t1] = bisected([&](double t) {
            Vec3 p = lo;
            p[axis] += side_ * t;
            return inside(p) == low_in;
        });
        // Vertices keep a negligible distance from corners, so that no triangle vanishes.
        constexpr double nudge = 1e-7;
        const double t = std::clamp(0.5 * (t0 + t1), nudge, 1 - nudge);
        Vec3 p = lo;
        p[axis] += side_ * t;
        mesh_.positions.push_back(p);
        const SignedDistance& there = field_.near(p);
        const SurfaceSample o = there.at(p);
        Vec3 normal = o.normal;
        if (normal == Vec3(0.0)) normal[axis] = low_in ? 1 : -1;
        mesh_.normals.push_back(normal);
        materials_.push_back(o.leaf < 0 ? 0 : there.material(o.leaf));
        return it->second;
    }

    void cube(int x, int y, int z) {
        double v[8];
        int inside = 0;
        for (int k = 0; k < 8; ++k) {
            v[k] = grid_.value(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
            inside += v[k] > 0;
        }
        if (inside == 0 || inside == 8) return;
        // Segments on the cube's faces, with the solid on their right seen from outside of the cube.
        std::vector<std::pair<int, int>> segments;
        std::vector<std::pair<int, int>> on_faces;  // vertex and face
        for (int f = 0; f < 6; ++f) {
            const int* c = face_corners[f];
            int out[2], in[2], outs = 0, ins = 0;  // crossings where the face's border leaves and enters the solid
            for (int k = 0; k < 4; ++k) {
                const int a = c[k], b = c[(k + 1) % 4];
                if ((v[a] > 0) == (v[b] > 0)) continue;
                const int vertex = vertex_on(x, y, z, a, b);
                on_faces.push_back({vertex, f});
                if (v[a] > 0)
                    out[outs++] = vertex;
                else
                    in[ins++] = vertex;
            }
            if (outs == 1) segments.push_back({in[0], out[0]});
            if (outs != 2) continue;
            // Around the face, a corner inside lies between in[i] and out[j]. If corners inside are joined they share
            // the middle of the face; otherwise each is cut off separately.
            const bool first_in = v[c[0]] > 0;
            const double p = v[c[0]] * v[c[2]], q = v[c[1]] * v[c[3]];
            const bool joined = (first_in ? p : q) > (first_in ? q : p);  // the saddle is above 0
            // out[0] comes before in[0] if corner 0 is inside.
            const int own_in[2] = {first_in ? in[1] : in[0], first_in ? in[0] : in[1]};
            for (int k = 0; k < 2; ++k) segments.push_back({joined ? own_in[1 - k] : own_in[k], out[k]});
        }
        while (!segments.empty()) {
            std::vector<int> loop;
            int at = segments.back().first;
            const int begin = at;
            do {
                loop.push_back(at);
                const auto s =
                    std::find_if(segments.begin(), segments.end(), [&](const auto& e) { return e.first == at; });
                at = s->second;
                segments.erase(s);
            } while (at != begin);
            fill(loop, on_faces, {x, y, z}, v);
        }
    }

    // Fills a loop by triangles. `values` are those at the corners of the cube at `at`.
    void fill(const std::vector<int>& loop, const std::vector<std::pair<int, int>>& on_faces,
              const std::array<int, 3>& at, const double* values) {
        // No diagonal may lie in a face of the cube, because the neighbour may have it, too.
        const auto share_face = [&](int a, int b) {
            for (const auto& [va, fa] : on_faces)
                if (va == a && std::find(on_faces.begin(), on_faces.end(), std::pair{b, fa}) != on_faces.end())
                    return true;
            return false;
        };
        const std::size_t n = loop.size();
        // The first fan that faces outward as its corners do, or else the best one.
        std::size_t best = n;
        double most = -infinity;
        for (std::size_t apex = 0; apex < n && most <= 0; ++apex) {
            bool good = true;
            for (std::size_t k = 2; k + 1 < n && good; ++k) good = !share_face(loop[apex], loop[(apex + k) % n]);
            if (!good) continue;
            double least = infinity;
            for (std::size_t k = 1; k + 1 < n; ++k)
                least = std::min(least, outwardness(loop[apex], loop[(apex + k) % n], loop[(apex + k + 1) % n]));
            if (least <= most) continue;
            most = least;
            best = apex;
        }
        if (best < n) {
            for (std::size_t k = 1; k + 1 < n; ++k)
                triangle(loop[best], loop[(best + k) % n], loop[(best + k + 1) % n]);
            return;
        }
        const Vec3 center = middle_of(loop, at, values);
        const SurfaceSample o = field_.at(center);
        const int middle = int(mesh_.positions.size());
        mesh_.positions.push_back(center);
        mesh_.normals.push_back(o.normal == Vec3(0.0) ? mesh_.normals[loop[0]] : o.normal);
        materials_.push_back(materials_[loop[0]]);
        for (std::size_t k = 0; k < n; ++k) triangle(middle, loop[k], loop[(k + 1) % n]);
    }

    // Two adjacent numbers of [0, 1], the first of which still satisfies `as_first`, as 0 does, and the second no more.
    template <class AsFirst>
    static std::pair<double, double> bisected(AsFirst as_first) {
        double t0 = 0, t1 = 1;
        while (t1 - t0 > 1e-15) {
            const double t = 0.5 * (t0 + t1);
            if (t <= t0 || t >= t1) break;
            (as_first(t) ? t0 : t1) = t;
        }
        return {t0, t1};
    }

    bool inside(Vec3 x) const { return box_.contains(x) && field_.inside(x); }

    // A point of the surface in the cube near the middle of the loop: on the normal there; if that leaves the cube,
    // where other facets may be crossed, on the way to the nearest corner on the other side.
    Vec3 middle_of(const std::vector<int>& loop, const std::array<int, 3>& at, const double* values) const {
        Vec3 center(0.0);
        for (const int v : loop) center += mesh_.positions[v] / double(loop.size());
        const Box cube{grid_.corner(at[0], at[1], at[2]), grid_.corner(at[0] + 1, at[1] + 1, at[2] + 1)};
        const double distance = field_.distance_along_normal(center, side_);
        const SurfaceSample o = field_.at(center);
        const Vec3 along = center + o.normal * (o.distance > 0 ? distance : -distance);
        if (distance < side_ && cube.contains(along)) return along;
        const bool in = inside(center);
        std::optional<Vec3> nearest;
        for (int k = 0; k < 8; ++k) {
            const Vec3 corner = grid_.corner(at[0] + (k & 1), at[1] + (k >> 1 & 1), at[2] + (k >> 2));
            if ((values[k] > 0) != in && (!nearest || glm::distance(corner, center) < glm::distance(*nearest, center)))
                nearest = corner;
        }
        const double t0 = bisected([&](double t) { return inside(center + t * (*nearest - center)) == in; }).first;
        return center + t0 * (*nearest - center);
    }

    // The cosine between a triangle and the sum of its corners' normals, times that sum's length; 0 if it has no area.
    double outwardness(int a, int b, int c) const {
        const auto x = [&](int v) { return mesh_.positions[v]; };
        const auto normal = [&](int v) { return mesh_.normals[v]; };
        const Vec3 area = glm::cross(x(b) - x(a), x(c) - x(a));
        const double twice = glm::length(area);
        return twice > 0 ? glm::dot(area, normal(a) + normal(b) + normal(c)) / twice : 0;
    }

    void triangle(int a, int b, int c) { mesh_.triangles.push_back({{a, b, c}, {a, b, c}, materials_[a], 0}); }

    DistanceField field_;
    Box box_;
    Grid grid_;
    double side_;
    CancelFlag cancel_;
    WorkProgress* progress_;
    Mesh mesh_;
    std::vector<int> materials_;
    std::unordered_map<std::size_t, int> on_edge_;
};

}  // namespace

double marching_cubes_grid(const SolidTree& solid, const Box& box) {
    const double radius = solid.min_radius();
    return radius > 0 ? 0.5 * radius : 0.01 * largest(box.hi - box.lo);
}

double marching_cubes_count(const Box& box, double grid) {
    double count = 1;
    for (int k = 0; k < 3; ++k) count *= std::ceil((box.hi[k] - box.lo[k]) / grid) + 2;
    return count;
}

Mesh marching_cubes(const SolidTree& solid, const Box& box, double grid, CancelFlag cancel, WorkProgress* progress) {
    if (box.empty()) return {};
    Mesh mesh = March(solid, box, grid, cancel, progress).run();
    merge_close(mesh);
    return mesh;
}

}  // namespace deburr
