// Solids as a scene writes them: the primary CSG tree [Lobb §2.2, figure 3], whose leaves are
// rounded densities and fields (field.hpp).
//
// A Solid is a cheap handle on an immutable, shared expression. A sharp half-space is a density of
// radius 0.
#pragma once
#include <memory>
#include <vector>

#include "bounds/density.hpp"

namespace deburr {

class Field;
struct SolidNode;

class Solid {
public:
    /// The set ρ > ½ of `density` with filter radius r ≥ 0 wherever it has none of its own.
    static Solid rounded(double r, Density density, int line = 0);
    static Solid sharp(Density density, int line = 0) { return rounded(0.0, std::move(density), line); }

    /// The same by true convolution with a ball of radius r > 0: the density is read as a Boolean
    /// function, which has no radii of its own.
    static Solid convolved(double r, Density density, int line = 0);
    /// The set f > 0.
    static Solid of_field(std::shared_ptr<const Field> field, int line = 0);

    friend Solid operator|(Solid a, Solid b);
    friend Solid operator&(Solid a, Solid b);
    friend Solid operator-(Solid a, Solid b);

    /// Gives everything in it that has no material yet the one with this index in the scene.
    Solid material(int index) const;
    /// Carries densities and fields along: x ↦ ρ(A⁻¹x). `map` must be regular.
    Solid transformed(const Affine& map) const;

    const SolidNode& node() const { return *node_; }

private:
    explicit Solid(std::shared_ptr<const SolidNode> node) : node_(std::move(node)) {}
    std::shared_ptr<const SolidNode> node_;
};

struct SolidNode {
    enum class Kind { rounded, field, unite, intersect, subtract, material, transform };
    Kind kind = Kind::rounded;
    std::vector<Solid> children;
    std::vector<Density> density;  // rounded: one
    double radius = 0.0;           // rounded
    bool convolved = false;        // rounded: truly
    std::shared_ptr<const Field> field;
    int material = -1;    // material
    Affine map;           // transform
    int line = 0;         // rounded, field: place in the scene, 0 unknown
    double leaves = 1.0;  // half-spaces below, and fields' sizes, counted once per use

    SolidNode() = default;
    SolidNode(const SolidNode&) = delete;
    SolidNode& operator=(const SolidNode&) = delete;
    ~SolidNode();
};

/// Whether the node's leaves are laid out together, each once per use. Unions and placements share theirs.
inline bool is_laid_out(const SolidNode& node) {
    using Kind = SolidNode::Kind;
    return node.kind == Kind::rounded || node.kind == Kind::field || node.kind == Kind::intersect ||
           node.kind == Kind::subtract;
}

}  // namespace deburr
