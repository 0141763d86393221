// Vectors and masks over several rays: short names for Highway's operations on doubles.
#if defined(DEBURR_LANES_INL) == defined(HWY_TARGET_TOGGLE)  // not yet included for this set of instructions
#ifdef DEBURR_LANES_INL
#undef DEBURR_LANES_INL
#else
#define DEBURR_LANES_INL
#endif

#include <hwy/highway.h>

#include "bounds/convex_density.hpp"
#include "raytracer/simd/inline.hpp"
#include "raytracer/simd/ray_packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace deburr {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, RayPacket::size>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

const D d;

DEBURR_INLINE V number(double x) { return hn::Set(d, x); }
DEBURR_INLINE V select(M m, V a, V b) { return hn::IfThenElse(m, a, b); }
DEBURR_INLINE M and_(M a, M b) { return hn::And(a, b); }
DEBURR_INLINE M or_(M a, M b) { return hn::Or(a, b); }
DEBURR_INLINE M and_not(M a, M b) { return hn::AndNot(b, a); }
// least, most and clamped choose between equal arguments as std::min, std::max and std::clamp do.
DEBURR_INLINE V least(V a, V b) { return select(b < a, b, a); }
DEBURR_INLINE V most(V a, V b) { return select(a < b, b, a); }
DEBURR_INLINE V clamped(V x, V lo, V hi) { return select(x < lo, lo, select(hi < x, hi, x)); }
DEBURR_INLINE bool none(M m) { return hn::AllFalse(d, m); }

DEBURR_INLINE M mask_of(Lanes bits) {
    const std::uint8_t bytes[8] = {std::uint8_t(bits), std::uint8_t(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
}
DEBURR_INLINE Lanes bits_of(M m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, m, bytes);
    return Lanes(bytes[0]) | Lanes(bytes[1]) << 8;
}

// The bits of `lanes` for the rays `first` … that one vector holds.
DEBURR_INLINE Lanes part_of(Lanes lanes, std::size_t first) {
    return (lanes >> first) & ((Lanes(1) << hn::Lanes(d)) - 1);
}

// The rays `first` … of a packet, as many as a vector holds.
struct Rays {
    V origin[3], direction[3];
    Rays(const RayPacket& rays, std::size_t first) {
        for (int k = 0; k < 3; ++k) {
            origin[k] = hn::Load(d, rays.origin[k] + first);
            direction[k] = hn::Load(d, rays.direction[k] + first);
        }
    }
    // α at each ray's origin, and its rate along each ray.
    V distance(const AlphaPlane& p) const { return along(p, origin) + number(p.base); }
    V rate(const AlphaPlane& p) const { return along(p, direction); }

private:
    static DEBURR_INLINE V along(const AlphaPlane& p, const V* v) {
        return number(p.slope.x) * v[0] + number(p.slope.y) * v[1] + number(p.slope.z) * v[2];
    }
};

// Stores the normals n of the rays in `asked`, turned against rays that enter and along rays that leave.
DEBURR_INLINE void store_against(const V* n, const Rays& rays, M entering, M asked, std::size_t first,
                                 double (*normal)[RayPacket::size]) {
    const M against = n[0] * rays.direction[0] + n[1] * rays.direction[1] + n[2] * rays.direction[2] < hn::Zero(d);
    const M turned = hn::Xor(against, entering);
    for (int k = 0; k < 3; ++k) {
        double* const to = normal[k] + first;
        hn::Store(select(asked, select(turned, hn::Neg(n[k]), n[k]), hn::Load(d, to)), d, to);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace deburr
HWY_AFTER_NAMESPACE();

#endif
