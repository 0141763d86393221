// Solids as a scene writes them: expressions of the primary CSG tree [Lobb §2.2, figure 3], whose leaves are rounded
// densities and fields (field.hpp).
//
// A Solid is a cheap handle on an immutable, shared expression. A sharp half-space is a density of
// radius 0.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>

#include "bounds/density.hpp"

namespace deburr {

class Field;
class SolidNode;

class Solid {
public:
    /// The set ρ > ½ of `density` with filter radius r ≥ 0 wherever the density has none of its own. `line` is that of
    /// the scene, for messages; 0 if it is unknown.
    static Solid rounded(double r, Density density, int line = 0);
    static Solid sharp(Density density, int line = 0) { return rounded(0.0, std::move(density), line); }

    /// The set ρ > ½ of the true convolution of `density` with a ball of radius r > 0. The density is read as a Boolean
    /// function and must not fix radii of its own (asserted).
    static Solid convolved(double r, Density density, int line = 0);
    /// The set f > 0 of the field.
    static Solid of_field(std::shared_ptr<const Field> field, int line = 0);

    friend Solid operator|(Solid a, Solid b);
    friend Solid operator&(Solid a, Solid b);
    friend Solid operator-(Solid a, Solid b);

    /// Assigns the scene's material with this index to every part that has none.
    Solid material(int index) const;
    /// The solid moved by `map`, filter radii included: x ↦ ρ(A⁻¹x). `map` must be regular.
    Solid transformed(const Affine& map) const;

    const SolidNode& node() const { return *node_; }

private:
    explicit Solid(std::shared_ptr<const SolidNode> node) : node_(std::move(node)) {}
    std::shared_ptr<const SolidNode> node_;
};

/// A node of the expression. A node stores only what its kind needs, because a scene that places a block a million
/// times has millions of nodes.
class SolidNode {
public:
    enum class Kind : std::uint8_t { rounded, field, unite, intersect, subtract, material, transform };
    struct Rounded {
        Density density;
        double radius;
        bool convolved;  // by true convolution
    };
    struct Material {
        Solid child;
        int index;
    };
    struct Transform {
        Solid child;
        Affine map;
    };
    using Operands = std::array<Solid, 2>;
    using Parts = std::variant<Rounded, std::shared_ptr<const Field>, Operands, Material, Transform>;

    SolidNode(Kind of_kind, double leaf_count, Parts parts, int of_line = 0)
        : kind(of_kind), line(of_line), leaves(leaf_count), parts_(std::move(parts)) {}
    SolidNode(const SolidNode&) = delete;
    SolidNode& operator=(const SolidNode&) = delete;
    ~SolidNode();  // iterative, so that a chain of any length is destroyed without recursion

    std::span<const Solid> children() const;
    // The following may be called only for nodes of the kinds that have the value.
    const Rounded& rounded() const { return *std::get_if<Rounded>(&parts_); }
    const Density& density() const { return rounded().density; }
    double radius() const { return rounded().radius; }
    bool convolved() const { return rounded().convolved; }
    int material() const { return std::get_if<Material>(&parts_)->index; }
    const Affine& map() const { return std::get_if<Transform>(&parts_)->map; }
    /// Null for nodes of other kinds.
    const std::shared_ptr<const Field>& field() const;

    const Kind kind;
    const int line;       // rounded, field: line of the scene, 0 unknown
    const double leaves;  // half-spaces below plus the sizes of fields, each counted once per use; may overflow to
                          // infinity

private:
    Parts parts_;
};

/// Whether flatten() lays the node's leaves out, each once per use. Unions and placements share their operands instead.
inline bool is_laid_out(const SolidNode& node) {
    using Kind = SolidNode::Kind;
    return node.kind == Kind::rounded || node.kind == Kind::field || node.kind == Kind::intersect ||
           node.kind == Kind::subtract;
}

}  // namespace deburr
