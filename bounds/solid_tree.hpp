// The primary CSG tree [Lobb §2.2, figure 3], flattened: its leaves are rounded densities and fields in world space.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"
#include "bounds/field.hpp"
#include "bounds/solid.hpp"

namespace deburr {

/// A leaf: the set ρ > ½ of a density, or the set f > 0 of a field.
struct SolidLeaf {
    DensityTree density;  // the constant 0 if the leaf is a field
    /// Index of the scene's material.
    int material = 0;
    int line = 0;         // line of the scene, 0 unknown
    FieldPtr field = {};  // null if the leaf is a density
};

enum class SolidOp : unsigned char { nothing, everything, leaf, unite, intersect, subtract };

/// A node of the tree; children are indices in SolidTree::nodes.
struct SolidTreeNode {
    SolidOp op = SolidOp::nothing;
    int a = -1, b = -1;  // children; leaf: a is its index in leaves
};

struct SolidTree {
    std::vector<SolidLeaf> leaves;
    std::vector<SolidTreeNode> nodes;  // children before parents, the root last; never empty

    int root() const { return int(nodes.size()) - 1; }
    /// The least filter radius > 0 of all leaves (a world distance); 0 if everything is sharp.
    double min_radius() const;
    /// Whether some leaf is a field that is no density (Field::is_density), such as a free form, a sharp torus or a
    /// mesh whose radius varies.
    bool has_free_form() const;
    /// Whether x is in the solid, by the definition [Lobb figure 4, PointInObject].
    bool contains(Vec3 x) const;
};

/// Thrown where placements that are each regular compose to a numerically singular map.
struct SingularPlacement : std::domain_error {
    explicit SingularPlacement(int of_line);
    int line;  // of the leaf in the scene; 0 unknown
};

/// Flattens a solid. Throws TooManyHalfSpaces, SingularPlacement, and BadRoundPart (density_tree.hpp).
SolidTree flatten(const Solid& solid);

}  // namespace deburr
