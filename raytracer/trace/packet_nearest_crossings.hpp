// Keeps the nearest crossing of each ray of a packet, by the rule of nearest_crossing.hpp.
#pragma once
#include "raytracer/simd/packet_kernels.hpp"
#include "raytracer/trace/packet_surfaces.hpp"
#include "raytracer/trace/surface_search.hpp"

namespace deburr {

/// A nearest crossing for each ray. Their distances are in RayTerms::end, which offers shorten.
class PacketNearestCrossings {
public:
    /// Primitives in Surfaces::infinite_planes are numbered from here on.
    static constexpr std::uint32_t first_infinite_plane = 1u << 31;

    /// Results are written to `found`, in part by finish().
    PacketNearestCrossings(const Surfaces& surfaces, PacketSurfaces& found) : surfaces_(surfaces), found_(found) {
        found_.found = 0;
    }

    /// Offers the crossings of `lanes` with one plane, convex, surface or sum primitive, whose normals are still
    /// unknown.
    void offer(std::uint32_t primitive, const PacketCrossings& crossings, Lanes lanes, RayTerms& terms) {
        const Lanes as_near = packet_functions.keep_nearer(terms, nearest_, crossings, lanes, primitive);
        for_each_lane(as_near, [&](int k) {
            if (!precedes(cell_primitive(primitive).solid, primitive, k)) return;
            take(k, primitive);
            const Lanes bit = Lanes(1) << k;
            nearest_.elsewhere &= ~bit;
            nearest_.plane[k] = crossings.plane[k];
            nearest_.entering = (nearest_.entering & ~bit) | (crossings.entering & bit);
        });
    }
    /// Offers a surface that ray k crosses, with a known normal: of a primitive or an instance.
    void offer(int k, const FoundSurface& surface, std::uint32_t number, RayTerms& terms) {
        if (takes(k, surface.crossing.t, surface.solid, number, terms)) found_.set(k, surface);
    }
    /// Offers the surfaces that rays found in an instance.
    void offer(const PacketSurfaces& surfaces, std::uint32_t number, RayTerms& terms) {
        for_each_lane(surfaces.found, [&](int k) {
            if (takes(k, surfaces.t[k], surfaces.solid[k], number, terms)) found_.set(k, surfaces);
        });
    }

    /// Stands in for a NearestCrossing and passes on offers for ray k.
    struct OfRay {
        void offer(const CellPrimitives& primitives, std::uint32_t i, const ConvexCrossing& c) {
            const CellPrimitive& p = primitives[i];
            const Vec3 normal = primitives.normal(p, c, ray.origin, ray.direction);
            offer({c.t, normal, p.material}, rounding_of(terms.coordinate_bound[k], c.t), p.solid, i);
        }
        void offer(const SurfaceCrossing& c, double error, int solid, std::uint32_t i) {
            all.offer(k, {c, solid, error}, first + i, terms);
        }

        PacketNearestCrossings& all;
        int k;
        const Ray& ray;
        std::uint32_t first;
        RayTerms& terms;
    };
    /// An adapter for ray k; the primitives offered to it are numbered from `first` on.
    OfRay of_ray(int k, const Ray& ray, std::uint32_t first, RayTerms& terms) { return {*this, k, ray, first, terms}; }

    /// Computes normals, solids, materials and errors of the crossings that are kept, and writes them to the result.
    void finish(const RayPacket& rays, const RayTerms& terms) {
        found_.found = nearest_.found;
        Lanes left = nearest_.found & ~nearest_.elsewhere;
        for_each_lane(left, [&](int k) {
            found_.t[k] = terms.end[k];
            found_.start[k] = 0;
            found_.error[k] = rounding_of(terms.coordinate_bound[k], terms.end[k]);
        });
        while (left != 0) {  // the rays whose nearest crossing is of one primitive are handled together
            const double number = nearest_.primitive[__builtin_ctz(left)];
            const CellPrimitive& p = cell_primitive(std::uint32_t(number));
            const double own_error = list(std::uint32_t(number)).error(p);
            Lanes here = 0;
            for_each_lane(left, [&](int k) {
                if (nearest_.primitive[k] != number) return;
                here |= Lanes(1) << k;
                found_.error[k] += own_error;
                found_.solid[k] = p.solid;
                found_.material[k] = p.material;
            });
            list(std::uint32_t(number)).normals(p, rays, terms.end, here, nearest_, found_.normal);
            left &= ~here;
        }
    }

private:
    const CellPrimitives& list(std::uint32_t number) const {
        return number < first_infinite_plane ? surfaces_.cell_primitives : surfaces_.infinite_planes;
    }
    const CellPrimitive& cell_primitive(std::uint32_t number) const {
        return list(number)[number & ~first_infinite_plane];
    }
    int solid(int k) const {
        return nearest_.elsewhere >> k & 1 ? found_.solid[k]
                                           : cell_primitive(std::uint32_t(nearest_.primitive[k])).solid;
    }
    // Whether a surface comes before ray k's nearest one, given that both are at the same distance.
    bool precedes(int of_solid, std::uint32_t number, int k) const {
        if (!(nearest_.found >> k & 1)) return true;
        return of_solid != solid(k) ? of_solid < solid(k) : number < nearest_.primitive[k];
    }
    void take(int k, std::uint32_t number) {
        nearest_.found |= Lanes(1) << k;
        nearest_.primitive[k] = number;
    }
    // Whether the surface at t is ray k's nearest now; if so, it is recorded as stored in found_ (`elsewhere`).
    bool takes(int k, double t, int of_solid, std::uint32_t number, RayTerms& terms) {
        if (!(t < terms.end[k]) && !(t == terms.end[k] && precedes(of_solid, number, k))) return false;
        take(k, number);
        nearest_.elsewhere |= Lanes(1) << k;
        terms.end[k] = t;
        return true;
    }

    const Surfaces& surfaces_;
    PacketSurfaces& found_;
    PacketNearest nearest_;
};

}  // namespace deburr
