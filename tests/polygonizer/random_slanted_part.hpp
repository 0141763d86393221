// Random parts with sharp round tools: cylinders, cones and spheres at any angle are subtracted from, or added to, a
// cube that is sharp or slightly rounded.
#pragma once
#include "bounds/solid.hpp"
#include "polygonizer/random_draws.hpp"

namespace deburr {

class RandomSlantedPart : RandomDraws {
public:
    explicit RandomSlantedPart(int seed) : RandomDraws(spread(seed)) {}

    /// In half of the cases the part is rotated and moved.
    Solid solid() {
        const Density cube = Density::box(Vec3(0.0), Vec3(1.0));
        Solid part = below(3) == 0 ? Solid::rounded(0.05, cube) : Solid::sharp(cube);
        for (int tools = 1 + below(2); tools > 0; --tools) {
            const Solid tool = Solid::sharp(this->tool());
            part = below(4) ? part - tool : part | tool;
        }
        return below(2) ? part.transformed(turn()) : part;
    }

private:
    double between(double a, double b) { return a + (b - a) * unit(); }
    Vec3 point(double from, double to) {
        const double x = between(-0.3, 1.3), y = between(-0.3, 1.3);
        return {x, y, between(from, to)};
    }
    Density tool() {
        const Vec3 from = point(-0.8, -0.3), to = point(1.3, 1.8);
        const double radius = between(0.05, 0.35);
        switch (below(4)) {
            case 0: return Density::sphere(0.5 * (from + to), radius);
            case 1: return Density::cone(from, to, radius, 0.5 * radius);
            default: return Density::cylinder(from, to, radius);
        }
    }
};

}  // namespace deburr
