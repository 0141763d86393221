// Random mechanical parts: plates, boxes, posts and brackets with holes, slots, pockets, ribs, bosses and chamfers.
// Dimensions are round numbers of millimetres.
#pragma once
#include <vector>

#include "bounds/solid_tree.hpp"
#include "polygonizer/random_draws.hpp"

namespace deburr {

class RandomPart : RandomDraws {
public:
    explicit RandomPart(int seed) : RandomDraws(spread(seed)) {}

    /// One Boolean density that is rounded as a whole, or rounded solids under primary CSG; in half of the cases
    /// rotated and moved.
    Solid solid() {
        constexpr double radii[] = {0, 0.2, 0.4, 0.5};
        radius_ = radii[below(4)];
        whole_ = below(3) > 0;
        wide_ = 12 + 4 * below(6);
        deep_ = 10 + 2 * below(6);
        thick_ = 2 + below(4);
        base();
        for (int features = 1 + below(3); features > 0; --features) switch (below(6)) {
                case 0: row_of_holes(); break;
                case 1: row_of_slots(); break;
                case 2: rib(); break;
                case 3: boss(); break;
                case 4: chamfer(); break;
                default: pocket();
            }
        const Solid s = whole_ ? Solid::rounded(radius_, density_[0]) : solid_[0];
        return below(2) ? s.transformed(turn()) : s;
    }
    /// Filter radius of the part made last; 0 if it is sharp.
    double radius() const { return radius_; }

private:
    void begin(const Density& d) {
        density_ = {d};
        solid_ = {Solid::rounded(radius_, d)};
    }
    void add(const Density& d) {
        density_[0] = density_[0] | d;
        solid_[0] = solid_[0] | Solid::rounded(radius_, d);
    }
    void cut(const Density& d) {
        density_[0] = density_[0] & ~d;
        solid_[0] = solid_[0] - Solid::rounded(radius_, d);
    }

    // A regular prism along z from `from` to `to`, around (x, y); `radius` is that of its corners.
    static Density prism(double x, double y, double radius, int sides, double from, double to) {
        std::vector<Density> faces{Density::half_space({0, 0, -1}, -from), Density::half_space({0, 0, 1}, to)};
        const double across = radius * std::cos(3.14159265358979323846 / sides);
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * 3.14159265358979323846 * k / sides;
            const Vec3 n(std::cos(angle), std::sin(angle), 0);
            faces.push_back(Density::half_space(n, across + n.x * x + n.y * y));
        }
        Density all = faces[0];
        for (std::size_t k = 1; k < faces.size(); ++k) all = all & faces[k];
        return all;
    }

    void base() {
        const Density plate = Density::box({0, 0, 0}, {wide_, deep_, thick_});
        switch (below(5)) {
            case 0:  // a post on a foot
                begin(plate);
                add(prism(wide_ / 2, deep_ / 2, 4, 6 + 2 * below(3), thick_ - 1, thick_ + 8));
                break;
            case 1:  // an angle
                begin(plate);
                add(Density::box({0, 0, 0}, {2, deep_, thick_ + 10}));
                break;
            case 2: {  // a tray
                thick_ = 8;
                begin(Density::box({0, 0, 0}, {wide_, deep_, thick_}));
                cut(Density::box({2, 2, 2}, {wide_ - 2, deep_ - 2, thick_ + 3}));
                thick_ = 2;
                break;
            }
            default: begin(plate);
        }
    }
    void row_of_holes() {
        const int count = 1 + below(4), sides = 6 + 2 * below(4);
        const double pitch = wide_ / (count + 1), radius = std::min(0.3 * pitch, 1.0 + 0.5 * below(3));
        const double y = deep_ * (0.3 + 0.1 * below(4));
        const bool blind = below(4) == 0;
        for (int k = 1; k <= count; ++k) {
            cut(prism(k * pitch, y, radius, sides, blind ? 1 : -1, 30));
            if (below(8) == 0 && thick_ > 2) cut(prism(k * pitch, y, 1.5 * radius, sides, thick_ - 1, 30));
        }
    }
    void row_of_slots() {
        const int count = 1 + below(4);
        const double pitch = wide_ / (count + 1);
        for (int k = 1; k <= count; ++k)
            cut(Density::box({k * pitch - 1, deep_ * 0.25, -1}, {k * pitch + 1, deep_ * 0.75, thick_ + 1}));
    }
    void rib() {
        const double y = below(2) ? 0 : 2.0 + below(int(deep_) - 4);
        add(Density::box({0, y, 0}, {wide_, y + 2, thick_ + 2 + below(4)}));
    }
    void boss() {
        const double x = 4 + below(int(wide_) - 8), y = 4 + below(int(deep_) - 7);
        const int sides = 6 + 2 * below(4);
        add(prism(x, y, 3, sides, thick_ - 1, thick_ + 3));
        if (below(2)) cut(prism(x, y, 1.5, sides, below(2) ? -1 : thick_, thick_ + 9));
    }
    void chamfer() {
        const double size = 1 + below(2);
        if (below(2))
            cut(Density::half_space(-glm::normalize(Vec3(1, 1, 0)), -(wide_ + deep_ - 2 * size) / std::sqrt(2.0)));
        else
            cut(Density::half_space(glm::normalize(Vec3(1, 0, -1)), (size - thick_) / std::sqrt(2.0)));
    }
    void pocket() {
        const double x = 2 + below(4), y = 2 + below(3);
        cut(Density::box({x, y, thick_ - 1}, {x + 4, y + 4, thick_ + 20}));
    }

    double radius_ = 0, wide_ = 0, deep_ = 0, thick_ = 0;
    bool whole_ = true;
    std::vector<Density> density_;  // one element: the part as one density
    std::vector<Solid> solid_;      // one element: the part in primary CSG
};

}  // namespace deburr
