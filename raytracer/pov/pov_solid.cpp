#include "raytracer/pov/pov_solid.hpp"

#include <algorithm>

#include "bounds/bounding_box.hpp"
#include "bounds/box_range.hpp"
#include "bounds/round_density.hpp"
#include "raytracer/pov/pov_csg.hpp"
#include "raytracer/pov/pov_field.hpp"
#include "raytracer/pov/pov_round.hpp"
#include "raytracer/pov/pov_text.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// Most parts that a density with sharp half-spaces is divided into; each is an isosurface.
constexpr int max_parts = 64;
// Distance of an isosurface's container from the surface, as a fraction of its size, since flat faces would otherwise
// lie in its walls.
constexpr double clear_of_walls = 1e-3;
constexpr double default_accuracy = 1e-4;  // of the least radius

// Plain CSG of a density with sharp half-spaces only.
PovCsg sharp_csg(const DensityTree& tree, const Box& as_far_as) {
    std::vector<PovCsg> done;
    for (const TreeNode& n : tree.nodes) {
        const auto take = [&](int i) { return std::move(done[i]); };
        PovCsg csg = PovCsg::nothing();
        switch (n.op) {
            case Op::constant:
                if (n.value > 0.5) csg = PovCsg::everything();
                break;
            case Op::half_space: {
                const HalfSpace& h = tree.half_spaces[n.a];
                if (!h.round)
                    csg = PovCsg::plane({h.normal, h.offset});
                else if (h.round->is_concave())  // the concave side of a cone cuts nothing off the other
                    csg = PovCsg::everything();
                else if (h.offset > 0 || h.round->is_cone())  // a distance is never negative
                    csg = PovCsg::object(pov_round_part(*h.round, h.offset, as_far_as));
                break;
            }
            case Op::sum:
            case Op::disjunction: csg = PovCsg::unite(take(n.a), take(n.b)); break;
            case Op::product:
            case Op::conjunction: csg = PovCsg::intersect(take(n.a), take(n.b)); break;
            case Op::difference: csg = PovCsg::subtract(take(n.a), take(n.b)); break;
            case Op::complement: csg = PovCsg::subtract(PovCsg::everything(), take(n.a)); break;
            case Op::convolution: csg = take(n.a); break;
        }
        done.push_back(std::move(csg));
    }
    return std::move(done.back());
}

// Writes one leaf of a solid.
class Leaves {
public:
    /// `in_csg`: the leaf is combined with others, so that a ray needs more than its first root.
    Leaves(const PovSurface& surface, const SolidLeaf& leaf, bool in_csg)
        : surface_(surface), leaf_(leaf), all_roots_(in_csg) {}

    PovCsg csg() {
        if (const auto* round = dynamic_cast<const RoundDensity*>(leaf_.field.get())) return csg(round->tree());
        if (leaf_.field) {
            const std::string smooth = pov_smooth(*leaf_.field);
            if (smooth.empty())
                throw UnsupportedError(of_leaf("expected rounded densities for POV-Ray, got another function"));
            return PovCsg::object(smooth);
        }
        if (leaf_.density.nodes.back().op == Op::convolution && !surface_.sharp)
            throw UnsupportedError(of_leaf("expected rounded densities for POV-Ray, got a true convolution"));
        return csg(leaf_.density);
    }
    bool cut() const { return cut_; }

private:
    std::string of_leaf(const std::string& what) const {
        return leaf_.line > 0 ? fmt::format("the solid of line {}: {}", leaf_.line, what) : what;
    }

    PovCsg csg(const DensityTree& tree) {
        const auto is_sharp = [&](const HalfSpace& h) { return surface_.sharp || h.radius == 0; };
        const auto first_sharp = std::find_if(tree.half_spaces.begin(), tree.half_spaces.end(), is_sharp);
        if (std::all_of(tree.half_spaces.begin(), tree.half_spaces.end(), is_sharp))
            return sharp_csg(tree, surface_.limit);
        if (first_sharp == tree.half_spaces.end()) return isosurface(tree);
        all_roots_ = true;
        const BoundPlane plane{first_sharp->normal, first_sharp->offset};
        const std::size_t index = std::size_t(first_sharp - tree.half_spaces.begin());
        return PovCsg::unite(PovCsg::intersect(PovCsg::plane(plane), divided(tree, index, 1)),
                             PovCsg::intersect(PovCsg::plane({-plane.normal, -plane.offset}), divided(tree, index, 0)));
    }

    // The tree with the density of one half-space replaced by `value` (0 or 1).
    PovCsg divided(const DensityTree& tree, std::size_t half_space, double value) {
        std::vector<Range> ranges(tree.half_spaces.size(), {0, 1});
        ranges[half_space] = {value, value};
        const Pruned part = prune(tree, ranges);
        if (classify(part.range) == Side::outside) return PovCsg::nothing();
        if (classify(part.range) == Side::inside) return PovCsg::everything();
        if (++parts_ > max_parts)
            throw UnsupportedError(of_leaf(fmt::format(
                "expected sharp half-spaces that divide a rounded density into {} parts at most for POV-Ray, got more",
                max_parts)));
        return csg(part.tree);
    }

    PovCsg isosurface(const DensityTree& tree) {
        if (tree.nodes.back().op == Op::half_space) {  // ρ = ½ is the surface of the half-space itself
            const HalfSpace& h = tree.half_spaces[tree.nodes.back().a];
            if (h.round) return PovCsg::object(pov_round_part(*h.round, h.offset, surface_.limit));
            return PovCsg::plane({h.normal, h.offset});
        }
        Box box =
            intersection(bounding_box(tree), leaf_.field ? leaf_.field->bounding_box() : bounding_box(leaf_.density));
        if (box.empty()) return PovCsg::nothing();
        if (!box.finite()) {
            cut_ = true;
            box = intersection(box, surface_.limit);
            if (box.empty()) return PovCsg::nothing();
        }
        const Vec3 size = box.hi - box.lo;
        box = inflated(box, clear_of_walls * max_component(size));
        double radius = infinity;
        for (const HalfSpace& h : tree.half_spaces) radius = std::min(radius, h.radius);
        const PovField field(tree, leaf_.line);
        std::string text = fmt::format(
            "isosurface {{\n  function {{ 0.5 - {} }}\n  contained_by {{ box {{ {}, {} }} }}\n  max_gradient {}\n  "
            "accuracy {}\n",
            field.formula(), pov_vector(box.lo), pov_vector(box.hi),
            surface_.max_gradient > 0 ? surface_.max_gradient : field.greatest_slope(box),
            surface_.accuracy > 0 ? surface_.accuracy : default_accuracy * radius);
        text += all_roots_ ? "  all_intersections\n}" : "}";
        return PovCsg::object(text);
    }

    const PovSurface& surface_;
    const SolidLeaf& leaf_;
    bool all_roots_;
    int parts_ = 1;
    bool cut_ = false;
};

}  // namespace

PovSolid pov_solid(const SolidTree& solid, const PovSurface& surface, const std::function<std::string(int)>& material) {
    PovSolid result;
    bool only_unions = true;
    for (const SolidTreeNode& n : solid.nodes) only_unions &= n.op != SolidOp::intersect && n.op != SolidOp::subtract;
    std::vector<PovCsg> done;
    for (const SolidTreeNode& n : solid.nodes) {
        const auto take = [&](int i) { return std::move(done[i]); };
        PovCsg csg = PovCsg::nothing();
        switch (n.op) {
            case SolidOp::nothing: break;
            case SolidOp::everything: csg = PovCsg::everything(); break;
            case SolidOp::leaf: {
                const SolidLeaf& leaf = solid.leaves[n.a];
                Leaves leaves(surface, leaf, !only_unions);
                csg = leaves.csg();
                result.cut |= leaves.cut();
                if (!csg.is_nothing()) csg = PovCsg::object(csg.text(material(leaf.material)));
                break;
            }
            case SolidOp::unite: csg = PovCsg::unite(take(n.a), take(n.b)); break;
            case SolidOp::intersect: csg = PovCsg::intersect(take(n.a), take(n.b)); break;
            case SolidOp::subtract: csg = PovCsg::subtract(take(n.a), take(n.b)); break;
        }
        done.push_back(std::move(csg));
    }
    if (!done.back().is_nothing()) result.text = done.back().text();
    return result;
}

}  // namespace deburr
