// Random CSG objects with what is hard for a mesher: flush faces, touching and nested parts, mixed radii.
#pragma once
#include "bounds/solid_tree.hpp"
#include "polygonizer/random_draws.hpp"

namespace deburr {

class RandomSolid : RandomDraws {
public:
    explicit RandomSolid(int seed) : RandomDraws(std::uint64_t(seed) * 7919 + 13) {}

    /// One rounded density, or a primary CSG tree of two or three of them.
    Solid solid() {
        Solid s = leaf();
        const int more = below(3) == 0 ? 1 + below(2) : 0;
        for (int k = 0; k < more; ++k) {
            const Solid t = leaf();
            const int op = below(3);
            s = op == 0 ? (s | t) : op == 1 ? (s - t) : (s & t);
        }
        return s;
    }

private:
    double grid() { return 0.25 * below(5); }

    Affine rotation() {
        Vec3 axis = glm::normalize(Vec3(unit() - 0.5, unit() - 0.5, unit() - 0.5) + Vec3(1e-3));
        double angle = 2 * pi * unit();
        if (below(3) == 0) {
            axis = Vec3(0.0);
            axis[below(3)] = 1;
            angle = 0.25 * pi * below(8);
        }
        return turn_about(axis, angle);
    }

    Density primitive() {
        const Vec3 lo(grid(), grid(), grid());
        const Vec3 size(0.25 * (1 + below(4)), 0.25 * (1 + below(4)), 0.25 * (1 + below(4)));
        const Density box = Density::box(lo, lo + size);
        const int kind = below(6);
        if (kind == 0) return box.transformed(rotation());
        if (kind == 1) {
            const int sides = 3 + below(4);
            std::vector<Density> faces;
            for (int k = 0; k < sides; ++k) {
                const double angle = 2 * 3.14159265358979323846 * k / sides;
                faces.push_back(Density::half_space({std::cos(angle), std::sin(angle), 0}, 0.4));
            }
            faces.push_back(Density::half_space({0, 0, 1}, 0.5));
            faces.push_back(Density::half_space({0, 0, -1}, 0.1));
            return Density::product(faces);
        }
        const double middle = lo.x + lo.y + lo.z + 0.5 * (size.x + size.y + size.z);
        return kind == 2 ? box * Density::half_space({1, 1, 1}, middle) : box;
    }

    Density part() {
        const Density d = primitive();
        return below(4) == 0 ? d.radius(0.05 * below(4)) : d;
    }

    Density density() {
        Density d = part();
        for (int k = below(4); k > 0; --k) {
            const Density other = part();
            switch (below(6)) {
                case 0: d = d + other; break;
                case 1: d = d - other; break;
                case 2: d = d * other; break;
                case 3: d = d & ~other; break;
                default: d = d | other;
            }
        }
        return d;
    }

    Solid leaf() {
        constexpr double radii[] = {0, 0.02, 0.05, 0.1, 0.125, 0.25, 0.3};
        const Solid s = Solid::rounded(radii[below(7)], density());
        return below(4) == 0 ? s.transformed(rotation()) : s;
    }
};

}  // namespace deburr
