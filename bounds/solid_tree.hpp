// The primary CSG tree [Lobb §2.2, figure 3], flat: rounded densities and fields in world space as
// leaves.
#pragma once
#include <vector>

#include "bounds/density_tree.hpp"
#include "bounds/field.hpp"
#include "bounds/solid.hpp"

namespace deburr {

struct SolidLeaf {
    DensityTree density;  // the leaf is the set ρ > ½; of a field, nothing: a constant 0
    int material = 0;
    int line = 0;
    FieldPtr field = {};  // if not null, the leaf is the set f > 0
};

enum class SolidOp : unsigned char { nothing, everything, leaf, unite, intersect, subtract };

struct SolidTreeNode {
    SolidOp op = SolidOp::nothing;
    int a = -1, b = -1;  // children; leaf: a is its index
};

struct SolidTree {
    std::vector<SolidLeaf> leaves;
    std::vector<SolidTreeNode> nodes;  // children before parents, the root last; never empty

    int root() const { return int(nodes.size()) - 1; }
    /// The least radius > 0; 0 if all is sharp.
    double min_radius() const;
    /// Is there a leaf that is neither a density nor a rounded mesh?
    bool has_free_form() const;
    /// The definition: [Lobb figure 4, PointInObject].
    bool contains(Vec3 x) const;
};

/// Thrown when placements that are each regular multiply to a numerically singular map.
struct SingularPlacement : std::domain_error {
    explicit SingularPlacement(int of_line);
    int line;  // of the leaf; 0 unknown
};

/// Throws TooManyHalfSpaces and SingularPlacement.
SolidTree flatten(const Solid& solid);

}  // namespace deburr
