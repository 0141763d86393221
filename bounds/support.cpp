#include "bounds/support.hpp"

#include "bounds/polyhedron_box.hpp"

namespace deburr {
namespace {

// Parts with fewer half-spaces get no support: looking at their planes is as quick.
constexpr int min_half_spaces = 4;

// Unit vector along the part of coordinate axis k that is perpendicular to the unit vector `axis`; 0 if they are
// parallel.
Vec3 component_across(Vec3 axis, int k) {
    Vec3 v(0.0);
    v[k] = 1;
    v -= axis * axis[k];
    const double length = glm::length(v);
    constexpr double parallel = 1e-9;
    return length > parallel ? v / length : Vec3(0.0);
}

bool is_intersection(Op op) { return op == Op::product || op == Op::conjunction; }

// The plane beyond which the half-space (or, with `complement`, its complement) is 0: a filter radius outside of its
// plane, and a few ulps.
BoundPlane edge_of(const HalfSpace& h, bool complement) {
    const double reach = h.radius + 4 * epsilon * (std::abs(h.offset) + h.radius);
    return complement ? BoundPlane{-h.normal, reach - h.offset} : BoundPlane{h.normal, h.offset + reach};
}

void add_edges(const HalfSpace& h, GatheredBox& to) {
    if (!h.round) {
        to.planes.push_back(edge_of(h, false));
        return;
    }
    for (const HalfSpace& touching : touching_planes(h)) {
        to.planes.push_back(edge_of(touching, false));
        to.planes.back().offset += 4 * epsilon * largest(h.round->center);
    }
}

bool bounded_somewhere(const Box& box) {
    for (int k = 0; k < 3; ++k)
        if (box.lo[k] > -infinity || box.hi[k] < infinity) return true;
    return false;
}

}  // namespace

std::vector<HalfSpace> touching_planes(const HalfSpace& part) {
    using Kind = RoundCoordinate::Kind;
    std::vector<HalfSpace> planes;
    const RoundCoordinate& c = *part.round;
    // empty, or all but a nappe
    if (c.across <= 0 || (!c.is_cone() && part.offset < 0)) return planes;
    for (int k = 0; k < 3; ++k)
        for (const double side : {1.0, -1.0}) {
            Vec3 normal(0.0);
            normal[k] = side;
            double offset = part.offset;
            if (c.kind == Kind::axis) {
                const Vec3 out = component_across(c.axis, k);
                if (out == Vec3(0.0)) continue;
                normal = c.across * side * out + c.along * c.axis;
            } else if (c.kind == Kind::circle) {
                offset += c.ring * std::sqrt(std::max(0.0, 1 - c.axis[k] * c.axis[k]));
            }
            planes.push_back({normal, offset + glm::dot(normal, c.center), part.radius});
        }
    return planes;
}

void find_supports(DensityTree& tree) {
    std::vector<char> whole(tree.nodes.size(), true);  // whether the node is not merely an operand of a larger
                                                       // intersection
    for (const TreeNode& n : tree.nodes)
        if (is_intersection(n.op)) whole[n.a] = whole[n.b] = false;

    std::vector<GatheredBox> all(tree.nodes.size());
    std::vector<int> half_spaces(tree.nodes.size(), 0);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        TreeNode& n = tree.nodes[i];
        const auto take = [&](int child) { return std::move(all[child]); };
        switch (n.op) {
            case Op::constant:
                if (n.value == 0) all[i].rest = {};
                break;
            case Op::half_space:
                add_edges(tree.half_spaces[n.a], all[i]);
                half_spaces[i] = 1;
                if (tree.half_spaces[n.a].round) {
                    half_spaces[i] = min_half_spaces;
                    const Box box = all[i].box();
                    if (bounded_somewhere(box)) {
                        tree.supports.push_back(box);
                        n.support = int(tree.supports.size()) - 1;
                    }
                }
                continue;
            case Op::complement: {
                const TreeNode& of = tree.nodes[n.a];
                if (of.op == Op::half_space && !tree.half_spaces[of.a].round)
                    all[i].planes.push_back(edge_of(tree.half_spaces[of.a], true));
                half_spaces[i] = half_spaces[n.a];
                continue;
            }
            case Op::convolution: all[i] = take(n.a); continue;
            case Op::product:
            case Op::conjunction: all[i] = intersect(take(n.a), take(n.b)); break;
            // also a difference: a − b may be negative where b is not 0
            default: all[i] = unite(take(n.a), take(n.b)); break;
        }
        if (n.op == Op::constant) continue;
        half_spaces[i] = half_spaces[n.a] + half_spaces[n.b];
        if (!whole[i] || half_spaces[i] < min_half_spaces) continue;
        const Box box = all[i].box();
        all[i] = {box, {}};
        if (!bounded_somewhere(box)) continue;
        tree.supports.push_back(box);
        n.support = int(tree.supports.size()) - 1;
    }
}

}  // namespace deburr
