// A tree over many lights, which chooses a light by importance, and finds those that a ray may meet, without visiting
// all [Conty Estevez & Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018; Pharr, Jakob &
// Humphreys, Physically Based Rendering, 4th edition, §12.6.3].
//
// As there, clusters near the point are split, since nothing is known of a cluster that contains it; but then a single
// light of all remaining clusters is chosen, instead of one of each. The probability of the choice is exact, and 0 only
// if the light gives nothing.
#pragma once
#include <optional>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Bounds of a light's position and emission. Far away, at distance d, it gives about power · cosine / d².
struct LightBounds {
    Box box;
    double power = 0.0;
    // The light emits up to 90 degrees from the directions within the angle `spread` (radians) around the axis; π: in
    // all directions.
    Vec3 axis{0, 0, 1};
    double spread = pi;
};

/// A tree over lights, which are named by their index in the list.
class LightTree {
public:
    LightTree() = default;
    /// Builds the tree; lights without power are left out.
    explicit LightTree(const std::vector<LightBounds>& lights);

    bool empty() const { return nodes_.empty(); }
    /// An estimate of the irradiance that all lights give at a point; 0 only if there is none.
    double importance(Vec3 point) const;
    /// The light at `at`, a uniform number from 0 to importance(point); none if the remaining candidates give nothing.
    std::optional<std::size_t> choose(Vec3 point, double at) const;
    /// A light's part of importance(point): divided by that, the probability with which choose() returns it.
    double importance(std::size_t light, Vec3 point) const;
    /// Calls each(light) for the lights whose box the ray may meet at distances up to t_max, which each() may lower.
    template <class Each>
    void for_each_near(const Ray& ray, const double& t_max, Each each) const {
        std::uint32_t stack[max_depth];
        int size = 0;
        if (!empty()) stack[size++] = 0;
        const Vec3 inverse = 1.0 / ray.direction;
        while (size > 0) {
            const std::uint32_t at = stack[--size];
            const Node& node = nodes_[at];
            if (!meets(node.bounds.box, ray.origin, inverse, t_max)) continue;
            if (node.light >= 0) {
                each(std::size_t(node.light));
                continue;
            }
            stack[size++] = node.right;
            stack[size++] = at + 1;
        }
    }

private:
    // A cluster of lights, or a single one.
    struct Node {
        LightBounds bounds;
        std::uint32_t right = 0;  // the left child follows its parent
        std::uint32_t parent = 0;
        int light = -1;  // index of a leaf's light; −1: inner node
    };
    // Levels: as many as halving a list of 2³¹ lights takes, after as many cuts by cost.
    static constexpr int max_depth = 128;

    std::uint32_t build(const std::vector<LightBounds>& lights, std::vector<int>& order, int begin, int end,
                        std::uint32_t parent, int depth);
    static bool is_split(const Node& node, Vec3 point);
    static double importance(const Node& node, Vec3 point);
    // Calls each(node, importance) for the clusters that remain after splitting, until it returns true.
    template <class Each>
    void for_each_cluster(Vec3 point, Each each) const;
    std::optional<std::size_t> choose_below(std::uint32_t node, Vec3 point, double u) const;
    double share_of_left(std::uint32_t node, Vec3 point) const;
    static bool meets(const Box& box, Vec3 origin, Vec3 inverse, double t_max) {
        double from = 0, to = t_max;
        for (int k = 0; k < 3; ++k) {
            const double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
            from = std::max(from, std::min(a, b));  // if NaN, unchanged
            to = std::min(to, std::max(a, b));
        }
        return from <= to;
    }

    std::vector<Node> nodes_;
    std::vector<std::int64_t> node_of_;  // by light; −1: left out
};

}  // namespace deburr
