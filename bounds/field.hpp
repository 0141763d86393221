// A leaf of the primary CSG tree that is no rounded density: the set f > 0 of a smooth function.
//
// What a kind of field must tell about itself is what the rest of the program asks of a density:
// its value and gradient, its range over a box, M, L and G along a ray, and the little of it that
// matters in a box. The ray tracer, the BSP and the polygonizers need to know no more.
//
// f and f′ must be continuous, and f″ bounded. f may have any unit; along a ray a field sets its own
// (begin_ray), so that rounding stays below what the root finder allows for.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bounds/box_range.hpp"
#include "bounds/ray_bounds.hpp"

namespace deburr {

class ClosedMesh;
class Field;
class FieldRay;
using FieldPtr = std::shared_ptr<const Field>;

/// Immutable; safe for several threads.
class Field {
public:
    virtual ~Field() = default;

    /// f and ∇f.
    virtual ValueGradient at(Vec3 x) const = 0;
    /// Holds f over the box, whose sides may be infinite; as tight as it can be had at little cost.
    virtual Range range(const Box& box) const = 0;
    /// Holds the set f > 0; sides may be infinite.
    virtual Box bounding_box() const = 0;
    /// A finite box around the part of an unbounded set in which its shape is seen; the bounding box
    /// of a bounded set. It is used only to estimate costs.
    virtual Box extent() const { return bounding_box(); }

    /// A field whose f has the same sign throughout the box, made of no more than matters there;
    /// null: this one.
    virtual FieldPtr prune(const Box&) const { return nullptr; }
    /// A density of a few half-spaces whose set ρ > ½ is the field's set throughout the box; none if a few are not
    /// enough. Called for boxes in which the range straddles 0.
    virtual std::optional<DensityTree> as_density(const Box&) const { return std::nullopt; }
    /// Whether f is ρ − ½ of some density ρ in [0, 1], with a filter's radius: triage can follow it.
    virtual bool is_density() const { return false; }
    /// The radius of the filter that rounds it; 0: none.
    virtual double filter_radius() const { return 0; }
    /// The closed mesh that it is the inside of, with no rounding; or null.
    virtual std::shared_ptr<const ClosedMesh> sharp_mesh() const { return nullptr; }
    /// Half-spaces along whose planes, and their parallels at ±radius, cutting space leaves less of the field on a
    /// side; only where they are few.
    virtual std::vector<HalfSpace> planes() const { return {}; }
    /// Holds the rate at which f changes along the unit direction, over the finite box.
    virtual Range rate_range(const Box&, Vec3 /*direction*/) const { return {-infinity, infinity}; }
    /// Cost of one evaluation, as a multiple of that of a half-space's density.
    virtual int size() const { return 1; }
    /// range(box), and size() of what `prune` would leave.
    virtual LocalSize local_size(const Box& box) const { return {range(box), size()}; }
    /// x ↦ f(A⁻¹x) as a field of its own kind, if it has one that is better than a wrapper; or null.
    virtual FieldPtr transformed_by(const Affine&) const { return nullptr; }

    /// A ray parameter ≥ 0 beyond which f keeps its sign along the ray; asked for rays that do not
    /// end.
    virtual double last_sign_change_bound(Vec3 origin, Vec3 direction) const = 0;
    /// Sets ray.noise_scale, and ray.numbers if the field uses them, from the ray's other members.
    virtual void begin_ray(FieldRay&) const {}
    /// Upper bound of FieldRay::noise_scale over all rays in the finite box: f is off by at most
    /// RootFinder::rounding of it anywhere in the box.
    virtual double max_noise_scale(const Box&) const { return 1; }
    /// f and df/dt in ray.noise_scale: there f must be off by less than RootFinder::rounding.
    virtual ValueSlope at(const FieldRay& ray, double t) const = 0;
    /// M, L and G of the same over [t0, t1].
    virtual RayBounds bounds(const FieldRay& ray, double t0, double t1) const = 0;
};

/// A field's notes on the latest ray, where FieldRay::numbers are not enough.
struct FieldRayState {
    virtual ~FieldRayState() = default;
};

/// A field along the ray o + t·d, where t0 ≤ t ≤ t1 < ∞. Cheap to set up again and again: keeps its
/// memory.
class FieldRay {
public:
    static constexpr double level = 0;  // of f on the surface

    /// Keeps a reference to `f`.
    void set(const Field& f, Vec3 o, Vec3 d, double from, double to) {
        field = &f;
        origin = o;
        direction = d;
        t0 = from;
        t1 = to;
        noise_scale = 1;
        f.begin_ray(*this);
    }
    ValueSlope at(double t) const { return field->at(*this, t); }
    /// The field's bounds, widened by 2⁻²⁰: where f″ is constant, two roots lie exactly at the limit of
    /// the criterion for one root (root_finder.hpp), and rounding would decide.
    RayBounds bounds(double from, double to) const {
        constexpr double wider = 1 + 0x1p-20;
        const RayBounds b = field->bounds(*this, from, to);
        return {b.M * wider, b.L * wider, b.G * wider};
    }

    const Field* field = nullptr;
    Vec3 origin{0.0}, direction{0.0};
    double t0 = 0, t1 = 0;
    double noise_scale = 1;                // of f here, in f's own
    std::vector<double> numbers;           // the field's own
    std::unique_ptr<FieldRayState> state;  // the field's own, or what another left
};

/// x ↦ f(A⁻¹x); null if `map` is singular to a double.
FieldPtr transformed(const FieldPtr& field, const Affine& map);

/// A ray parameter ≥ 0 beyond which the ray is outside of the box for good; `infinity` if it never
/// is. For fields that are bounded, what `last_sign_change_bound` may return.
double leaves_box(const Box& box, Vec3 origin, Vec3 direction);

}  // namespace deburr
