#include "bounds/vec.hpp"

namespace deburr {

Eigensystem eigensystem(Mat3 a) {
    constexpr int sweeps = 12;  // six are enough, since convergence is quadratic
    Mat3 v(1.0);
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0) continue;
                const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                Mat3 r(1.0);
                r[p][p] = r[q][q] = c;
                r[q][p] = s;
                r[p][q] = -s;
                a = glm::transpose(r) * a * r;
                a[p][q] = a[q][p] = 0;
                v = v * r;
            }
    return {v, {a[0][0], a[1][1], a[2][2]}};
}

// An image is off by rounding by at most this fraction of the sum of the absolute values of its terms.
constexpr double image_slack = 16 * epsilon;

Box image(const Affine& map, const Box& box) {
    Box to{map.shift, map.shift};
    for (int row = 0; row < 3; ++row) {
        double sum = std::abs(map.shift[row]);
        for (int k = 0; k < 3; ++k) {
            const double m = map.linear[k][row];
            if (m == 0) continue;  // 0·∞ would be NaN
            to.lo[row] += m * (m > 0 ? box.lo[k] : box.hi[k]);
            to.hi[row] += m * (m > 0 ? box.hi[k] : box.lo[k]);
            for (const double side : {box.lo[k], box.hi[k]})
                if (std::isfinite(side)) sum += std::abs(m * side);
        }
        to.lo[row] -= image_slack * sum;
        to.hi[row] += image_slack * sum;
    }
    return to;
}

}  // namespace deburr
