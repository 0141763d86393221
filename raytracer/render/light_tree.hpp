// A tree over many lights, which finds one of them by its importance, and those that a ray may meet, without asking all
// [Conty Estevez & Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018; Pharr, Jakob &
// Humphreys, Physically Based Rendering, 4th edition, §12.6.3].
//
// As there, what is near is split, for nothing is known of a cluster that one stands in; but one of all that the
// splitting leaves is then chosen, in place of one of each. The choice has its exact probability, which is 0 only where
// the light gives nothing.
#pragma once
#include <numbers>
#include <optional>
#include <vector>

#include "bounds/vec.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Where a light is and where it shines. At a distance d from it, far away, it gives about power · cosine / d².
struct LightBounds {
    Box box;
    double power = 0.0;
    // It shines up to 90 degrees from the directions within `spread`, an angle, around the axis; π: everywhere.
    Vec3 axis{0, 0, 1};
    double spread = std::numbers::pi;
};

class LightTree {
public:
    LightTree() = default;
    /// The lights are named by their places in the list. Those without power are left out.
    explicit LightTree(const std::vector<LightBounds>& lights);

    bool empty() const { return nodes_.empty(); }
    /// About the irradiance that all of them give at a point; 0 only where there is none.
    double importance(Vec3 point) const;
    /// A light for an even number from 0 to importance(point), none where those left give nothing.
    std::optional<std::size_t> choose(Vec3 point, double at) const;
    /// Its part of all importance, which is the probability with which choose() finds the light.
    double importance(std::size_t light, Vec3 point) const;
    /// Calls each(light) for those whose boxes the ray may meet at distances up to t_max, which each() may lower.
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
    struct Node {
        LightBounds bounds;
        std::uint32_t right = 0;  // the left child follows its parent
        std::uint32_t parent = 0;
        int light = -1;
    };
    // Halves of a list of 2³¹ lights, were they all cut in the middle, and as many cuts by cost before that.
    static constexpr int max_depth = 128;

    std::uint32_t build(const std::vector<LightBounds>& lights, std::vector<int>& order, int begin, int end,
                        std::uint32_t parent, int depth);
    static bool is_split(const Node& node, Vec3 point);
    static double importance(const Node& node, Vec3 point);
    // Calls each(node, importance) for what the splitting leaves, until it returns true.
    template <class Each>
    void for_each_cluster(Vec3 point, Each each) const;
    std::optional<std::size_t> choose_below(std::uint32_t node, Vec3 point, double u) const;
    double share_of_left(std::uint32_t node, Vec3 point) const;
    static bool meets(const Box& box, Vec3 origin, Vec3 inverse, double t_max) {
        double from = 0, to = t_max;
        for (int k = 0; k < 3; ++k) {
            const double a = (box.lo[k] - origin[k]) * inverse[k], b = (box.hi[k] - origin[k]) * inverse[k];
            from = std::max(from, std::min(a, b));  // NaN leaves it as it is
            to = std::min(to, std::max(a, b));
        }
        return from <= to;
    }

    std::vector<Node> nodes_;
    std::vector<std::int64_t> node_of_;  // by light; -1: it is left out
};

}  // namespace deburr
