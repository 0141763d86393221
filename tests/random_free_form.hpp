// Random quadrics and free forms. Each is a function of a seed alone.
#pragma once
#include "bounds/free_form.hpp"
#include "random_case.hpp"

namespace deburr {

/// A quadric of any kind, bounded or not; its axes are parallel to the coordinate axes in most cases.
inline Quadric random_quadric(Gen& g) {
    Quadric q;
    q.center = g.point(1);
    q.k = g.between(-0.3, 1);
    for (int k = 0; k < 3; ++k) {
        q.A[k][k] = g.chance(0.2) ? 0 : g.chance(0.7) ? -g.between(0.3, 6) : g.between(0.3, 3);
        q.b[k] = g.chance(0.7) ? 0 : g.between(-2, 2);
    }
    if (q.is_constant()) q.b.y = 1;
    return g.chance(0.4) ? transformed(q, g.map()) : q;
}

/// An ellipsoid with semi-axes in [least, most] and its center in [−reach, reach]³.
inline Quadric random_ellipsoid(Gen& g, double least, double most, double reach) {
    Quadric q;
    q.center = g.point(reach);
    q.k = 1;
    for (int k = 0; k < 3; ++k) {
        const double r = g.between(least, most);
        q.A[k][k] = -1 / (r * r);
    }
    if (!g.chance(0.5)) return q;
    Affine turn;
    turn.linear = g.map(false).linear;
    turn.shift = q.center - turn.linear * q.center;
    return transformed(q, turn);
}

/// A free form about as large as the unit ball, with this number of perturbations, some of them negative.
inline std::shared_ptr<const FreeForm> random_free_form(Gen& g, int perturbations) {
    const double size = g.between(0.5, 1);
    std::vector<Perturbation> all;
    const double most = perturbations > 20 ? 0.5 : 1.0;
    for (int i = 0; i < perturbations; ++i) {
        const double factor = (g.chance(0.4) ? -1 : 1) * g.between(0.1, 2);
        const bool infinite = g.chance(0.03);
        all.push_back({factor, infinite ? random_quadric(g) : random_ellipsoid(g, 0.15, most, 1.2)});
    }
    return std::make_shared<const FreeForm>(random_ellipsoid(g, 0.5 * size, size, 0.2), std::move(all));
}

}  // namespace deburr
