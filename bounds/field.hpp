// A leaf of the primary CSG tree that is not a density of half-spaces: the set f > 0 of a smooth function f.
//
// A kind of field answers what the rest of the program asks of a density: its value and gradient, its range over a box,
// M, L and G along a ray, and a simpler field that agrees with it in a box. The ray tracer, the BSP and the
// polygonizers need to know no more.
//
// f and f′ must be continuous, and f″ bounded. f may have any unit; along a ray a field chooses its own (begin_ray),
// such that rounding stays below what the root finder allows for.
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

/// The radius by which a field stands for a sharp solid, relative to the solid's size.
constexpr double sharp_radius = 0x1p-26;

/// Immutable, and safe to use from several threads.
class Field {
public:
    virtual ~Field() = default;

    /// f and ∇f at x.
    virtual ValueGradient at(Vec3 x) const = 0;
    /// A range that holds f over the box, whose sides may be infinite; as tight as can be had at little cost.
    virtual Range range(const Box& box) const = 0;
    /// A box that holds the set f > 0; sides may be infinite.
    virtual Box bounding_box() const = 0;
    /// A finite box around the part of an unbounded set where its shape shows; the bounding box of a bounded set. It is
    /// used only to estimate costs.
    virtual Box extent() const { return bounding_box(); }

    /// A simpler field whose f has the same sign as this one's throughout the box; null if there is none simpler.
    virtual FieldPtr prune(const Box&) const { return nullptr; }
    /// A density of a few half-spaces whose set ρ > ½ is the field's set throughout the box; none if it would take
    /// many. It is called only for boxes over which the range straddles 0.
    virtual std::optional<DensityTree> as_density(const Box&) const { return std::nullopt; }
    /// Whether f = ρ − ½ for some density ρ in [0, 1] with a filter radius. Triage can mesh such fields.
    virtual bool is_density() const { return false; }
    /// The radius of the filter that rounds the set (a world distance); 0 if nothing does.
    virtual double filter_radius() const { return 0; }
    /// The closed mesh whose inside the set is, if it is not rounded; else null.
    virtual std::shared_ptr<const ClosedMesh> sharp_mesh() const { return nullptr; }
    /// Planes that are worth cutting space along, also at their parallels at ±radius, because less of the field is left
    /// on either side. Empty if they would be many.
    virtual std::vector<HalfSpace> planes() const { return {}; }
    /// A unit vector along which f does not change in the box that this field was pruned to; none if there is none or
    /// it is not known, and for fields of parallel planes.
    virtual std::optional<Vec3> swept_along() const { return std::nullopt; }
    /// A range that holds the rate at which f changes along the unit vector, over the finite box.
    virtual Range rate_range(const Box&, Vec3 /*direction*/) const { return {-infinity, infinity}; }
    /// Cost of one evaluation, as a multiple of that of a half-space's density.
    virtual int size() const { return 1; }
    /// range(box), and size() of the field that prune(box) would leave.
    virtual LocalSize local_size(const Box& box) const { return {range(box), size()}; }
    /// The field x ↦ f(A⁻¹x) of this field's own kind, if that is better than a wrapper; else null.
    virtual FieldPtr transformed_by(const Affine&) const { return nullptr; }

    /// A ray parameter ≥ 0 beyond which f keeps its sign along the ray. It is called for rays that do not end.
    virtual double last_sign_change_bound(Vec3 origin, Vec3 direction) const = 0;
    /// Chooses ray.noise_scale from the ray's other members, and sets ray.numbers and ray.state if the field uses them.
    /// Called once for every ray.
    virtual void begin_ray(FieldRay&) const {}
    /// Upper bound of FieldRay::noise_scale over all rays within the finite box: there rounding makes an error of f of
    /// at most RootFinder::rounding times this.
    virtual double max_noise_scale(const Box&) const { return 1; }
    /// f and df/dt at t, both divided by ray.noise_scale. Rounding must make an error of less than RootFinder::rounding
    /// in the quotient.
    virtual ValueSlope at(const FieldRay& ray, double t) const = 0;
    /// M, L and G of that quotient over [t0, t1].
    virtual RayBounds bounds(const FieldRay& ray, double t0, double t1) const = 0;
};

/// What a field remembers of the latest ray, where FieldRay::numbers is not enough.
struct FieldRayState {
    virtual ~FieldRayState() = default;
};

/// A field along the ray o + t·d for t0 ≤ t ≤ t1 < ∞. It keeps its memory from one ray to the next, so it is cheap to
/// set again.
class FieldRay {
public:
    static constexpr double level = 0;  // f on the surface

    /// Sets the ray. Keeps a reference to `f`.
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
    /// The field's bounds, widened by 2⁻²⁰: where f″ is constant, two roots may lie exactly at the limit of the
    /// criterion (root_finder.hpp), and rounding would decide.
    RayBounds bounds(double from, double to) const {
        constexpr double wider = 1 + 0x1p-20;
        const RayBounds b = field->bounds(*this, from, to);
        return {b.M * wider, b.L * wider, b.G * wider};
    }

    const Field* field = nullptr;
    Vec3 origin{0.0}, direction{0.0};
    double t0 = 0, t1 = 0;
    double noise_scale = 1;                // unit of at() and bounds() on this ray, in units of f
    std::vector<double> numbers;           // owned by the field
    std::unique_ptr<FieldRayState> state;  // owned by the field; it may be what another field has left
};

/// The field x ↦ f(A⁻¹x); null if `map` or its inverse is not finite.
FieldPtr transformed(const FieldPtr& field, const Affine& map);

/// A ray parameter ≥ 0 beyond which the ray stays outside of the box; `infinity` if there is none. Bounded fields may
/// return it as last_sign_change_bound().
double leaves_box(const Box& box, Vec3 origin, Vec3 direction);

}  // namespace deburr
