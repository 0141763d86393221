// Solids as a scene writes them: the primary CSG tree [Lobb §2.2, figure 3], whose leaves are
// rounded densities and fields (field.hpp).
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

    /// Assigns the scene's material with this index to every part that has none.
    Solid material(int index) const;
    /// Carries densities and fields along: x ↦ ρ(A⁻¹x). `map` must be regular.
    Solid transformed(const Affine& map) const;

    const SolidNode& node() const { return *node_; }

private:
    explicit Solid(std::shared_ptr<const SolidNode> node) : node_(std::move(node)) {}
    std::shared_ptr<const SolidNode> node_;
};

/// One step of the expression. A scene has millions of them where it places a block that often, so a node keeps what
/// its kind needs.
class SolidNode {
public:
    enum class Kind : std::uint8_t { rounded, field, unite, intersect, subtract, material, transform };
    struct Rounded {
        Density density;
        double radius;
        bool convolved;  // truly
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
    ~SolidNode();  // iterative, so that a chain of any length dies without recursion

    std::span<const Solid> children() const;
    // For the kinds that have them.
    const Rounded& rounded() const { return *std::get_if<Rounded>(&parts_); }
    const Density& density() const { return rounded().density; }
    double radius() const { return rounded().radius; }
    bool convolved() const { return rounded().convolved; }
    int material() const { return std::get_if<Material>(&parts_)->index; }
    const Affine& map() const { return std::get_if<Transform>(&parts_)->map; }
    /// Null for other kinds.
    const std::shared_ptr<const Field>& field() const;

    const Kind kind;
    const int line;       // rounded, field: place in the scene, 0 unknown
    const double leaves;  // half-spaces below, and fields' sizes, counted once per use

private:
    Parts parts_;
};

/// Whether the node's leaves are laid out together, each once per use. Unions and placements share theirs.
inline bool is_laid_out(const SolidNode& node) {
    using Kind = SolidNode::Kind;
    return node.kind == Kind::rounded || node.kind == Kind::field || node.kind == Kind::intersect ||
           node.kind == Kind::subtract;
}

}  // namespace deburr
