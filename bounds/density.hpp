// Densities as a scene writes them: expressions over unrounded half-spaces and round parts with the papers' sums,
// products and differences [Lobb §2.2] and with Boolean operators.
//
// A Density is a cheap handle on an immutable, shared expression. Nothing is evaluated here: flatten()
// (density_tree.hpp) turns the expression, a filter radius and a placement into a DensityTree that can be evaluated.
//
// Not promised: legality. `a + b` of overlapping parts and `a - b` of parts that stick out leave [0, 1]; find_illegal()
// (legality.hpp) looks for that.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "bounds/round_coordinate.hpp"
#include "bounds/vec.hpp"

namespace deburr {

class DensityNode;

class Density {
public:
    /// The half-space n·x ≤ d. `normal` points outward and may have any length but 0; d is divided by the same length.
    static Density half_space(Vec3 normal, double offset);
    /// A half-space that is moved outward by its filter radius when it is rounded, so that its density is 1 wherever
    /// n·x ≤ d, rounded or not. It bounds sets that have no bounds of their own, and changes nothing of what lies
    /// within.
    static Density cover(Vec3 normal, double offset);
    /// The set where the coordinate is at most `offset` > 0: a ball, an infinite cylinder, a torus, or a nappe of a
    /// cone.
    static Density round(const RoundCoordinate& coordinate, double offset);
    /// The ball of this radius around the centre.
    static Density sphere(Vec3 center, double radius);
    /// The cylinder of this radius around the segment, with flat ends; `from` ≠ `to`.
    static Density cylinder(Vec3 from, Vec3 to, double radius);
    /// The (truncated) cone around the segment, with one radius at `from` and the other at `to`, not both 0; `from` ≠
    /// `to`. An end of radius 0 is the apex; ends of a radius > 0 are flat.
    static Density cone(Vec3 from, Vec3 to, double radius_from, double radius_to);
    /// The torus whose tube of radius `tube` runs around the circle of radius `radius` about the unit vector `axis`;
    /// tube < radius.
    static Density torus(Vec3 center, Vec3 axis, double radius, double tube);
    /// The box as a product of six half-spaces; lo < hi on each axis.
    static Density box(Vec3 lo, Vec3 hi);
    /// Product of all parts, of which there is at least one.
    static Density product(std::vector<Density> parts);

    /// The papers' arithmetic. `line` is the line of the scene that wrote the operator, for messages; 0 if it is
    /// unknown.
    static Density sum(Density a, Density b, int line = 0);
    static Density product(Density a, Density b, int line = 0);
    static Density difference(Density a, Density b, int line = 0);
    /// Boolean densities: below a Boolean operator the whole operand is read as a Boolean function.
    static Density disjunction(Density a, Density b);
    static Density conjunction(Density a, Density b);
    static Density complement(Density a);

    friend Density operator+(Density a, Density b) { return sum(a, b); }
    friend Density operator*(Density a, Density b) { return product(a, b); }
    friend Density operator-(Density a, Density b) { return difference(a, b); }
    friend Density operator|(Density a, Density b) { return disjunction(a, b); }
    friend Density operator&(Density a, Density b) { return conjunction(a, b); }
    friend Density operator~(Density a) { return complement(a); }

    /// Fixes the filter radius of those half-spaces that have none yet [Lobb §4.2, Triage §4.5.3].
    Density radius(double r) const;
    /// The transformed polyhedron, which is rounded after it is placed: filter radii do not scale. `map` must be
    /// regular.
    Density transformed(const Affine& map) const;
    /// Whether radius() was used anywhere in the expression.
    bool has_radius() const;

    const DensityNode& node() const { return *node_; }

private:
    explicit Density(std::shared_ptr<const DensityNode> node) : node_(std::move(node)) {}
    std::shared_ptr<const DensityNode> node_;
};

/// A node of the expression. Children are shared, so expressions are acyclic graphs. A node stores only what its kind
/// needs, because a scene may have millions of nodes.
class DensityNode {
public:
    enum class Kind : std::uint8_t {
        half_space,
        cover,
        round,
        sum,
        product,
        difference,
        disjunction,
        conjunction,
        complement,
        radius,
        transform
    };
    struct HalfSpace {
        Vec3 normal;  // unit
        double offset;
    };
    struct Radius {
        Density child;
        double radius;
    };
    struct Transform {
        Density child;
        Affine map;
    };
    using Operands = std::array<Density, 2>;
    using Parts = std::variant<HalfSpace, Density, Operands, std::vector<Density>, Radius, Transform,
                               std::unique_ptr<const RoundPart>>;

    DensityNode(Kind kind, Parts parts, int line = 0);
    DensityNode(const DensityNode&) = delete;
    DensityNode& operator=(const DensityNode&) = delete;
    ~DensityNode();  // iterative, so that a chain of any length is destroyed without recursion

    std::span<const Density> children() const;
    bool is_plane() const { return kind == Kind::half_space || kind == Kind::cover; }
    // The following may be called only for nodes of the kinds that have the value.
    const Vec3& normal() const { return std::get_if<HalfSpace>(&parts_)->normal; }
    double offset() const { return std::get_if<HalfSpace>(&parts_)->offset; }
    double radius() const { return std::get_if<Radius>(&parts_)->radius; }
    const Affine& map() const { return std::get_if<Transform>(&parts_)->map; }
    const RoundPart& round() const { return **std::get_if<std::unique_ptr<const RoundPart>>(&parts_); }

    const Kind kind;
    bool has_radius = false;      // whether this or a node below is Kind::radius
    bool has_round = false;       // whether this or a node below is Kind::round
    bool may_be_illegal = false;  // whether this or a node below is a sum or difference that no Boolean operator is
                                  // above
    const int line;               // sum, product, difference: line of the scene that wrote it, 0 unknown
    double leaves = 1.0;  // half-spaces and round parts below, each counted once per use; may overflow to infinity

private:
    Parts parts_;
};

}  // namespace deburr
