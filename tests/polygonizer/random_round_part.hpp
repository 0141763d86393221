// Random mechanical parts with round densities: plates, blocks and discs with bores, counterbores, cross bores, pins,
// spheres added or cut out, countersinks and grooves. Dimensions are round numbers of millimetres.
#pragma once
#include <cmath>

#include "bounds/solid_tree.hpp"
#include "polygonizer/random_draws.hpp"

namespace deburr {

class RandomRoundPart : RandomDraws {
public:
    explicit RandomRoundPart(int seed) : RandomDraws(spread(seed)) {}

    /// One Boolean density that is rounded as a whole; in half of the cases rotated and moved.
    Solid solid() {
        constexpr double radii[] = {0.2, 0.4, 0.5};
        radius_ = radii[below(3)];
        wide_ = 16 + 4 * below(5);
        deep_ = 12 + 2 * below(4);
        thick_ = 2 + 2 * below(3);
        if (below(3) == 0)
            part_ = upright(wide_ / 2, deep_ / 2, deep_ / 2, 0, thick_);
        else
            part_ = Density::box({0, 0, 0}, {wide_, deep_, thick_});
        for (int features = 1 + below(3); features > 0; --features) switch (below(7)) {
                case 0: bores(); break;
                case 1: countersink(); break;
                case 2: pin(); break;
                case 3: cross_bore(); break;
                case 4: dome(); break;
                case 5: dent(); break;
                default: groove();
            }
        const Solid s = Solid::rounded(radius_, part_);
        return below(2) ? s.transformed(turn()) : s;
    }
    /// Filter radius of the part made last.
    double radius() const { return radius_; }

private:
    static Density upright(double x, double y, double radius, double from, double to) {
        return Density::cylinder({x, y, from}, {x, y, to}, radius);
    }
    void add(const Density& d) { part_ = part_ | d; }
    void cut(const Density& d) { part_ = part_ & ~d; }

    void bores() {
        const int count = 1 + below(3);
        const double pitch = wide_ / (count + 1), radius = 0.75 + 0.25 * below(5), y = deep_ * (0.3 + 0.1 * below(4));
        const bool blind = below(4) == 0, wider = below(3) == 0 && thick_ > 2;
        for (int k = 1; k <= count; ++k) {
            cut(upright(k * pitch, y, radius, blind ? 1 : -1, 30));
            if (wider) cut(upright(k * pitch, y, radius + 1, thick_ - 1, 30));
        }
    }
    void countersink() {
        const double x = wide_ / 2 - 2 + below(5), y = deep_ / 2, radius = 1 + 0.5 * below(2);
        cut(upright(x, y, radius, -1, 30));
        cut(Density::cone({x, y, thick_ - 1}, {x, y, thick_ + 1}, radius, radius + 2));
    }
    void pin() {
        const double x = wide_ / 2 - 2 + below(5), y = deep_ / 2 - 1 + below(3), radius = 1.5 + 0.5 * below(3);
        const double top = thick_ + 3 + below(4);
        add(upright(x, y, radius, thick_ - 1, top));
        switch (below(4)) {
            case 0: cut(upright(x, y, 0.5 * radius, below(2) ? -1 : thick_, top + 1)); break;
            case 1: add(Density::cone({x, y, top - 1}, {x, y, top + 2}, radius + 0.5, 0.5)); break;
            default: break;
        }
    }
    void cross_bore() {
        const double x = wide_ / 2 - 3 + below(7), z = thick_ / 2, radius = std::min(0.25 * thick_, 1.0);
        cut(Density::cylinder({x, -1, z}, {x, deep_ + 1, z}, radius));
    }
    void dome() {
        const double radius = 2 + 0.5 * below(4);
        add(Density::sphere({wide_ / 2 - 2 + below(5), deep_ / 2, thick_}, radius));
    }
    void dent() { cut(Density::sphere({wide_ / 2 - 2 + below(5), deep_ / 2, thick_ + 1}, 2 + 0.5 * below(3))); }
    void groove() {
        cut(Density::torus({wide_ / 2, deep_ / 2, thick_}, {0, 0, 1}, 3 + 0.5 * below(4), 0.75 + 0.25 * below(2)));
    }

    double radius_ = 0, wide_ = 0, deep_ = 0, thick_ = 0;
    Density part_ = Density::box(Vec3(0.0), Vec3(1.0));
};

}  // namespace deburr
