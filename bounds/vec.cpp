#include "bounds/vec.hpp"

namespace deburr {

// Rounding moves an image by no more than this share of what was added up.
constexpr double image_slack = 16 * epsilon;

Box image(const Affine& map, const Box& box) {
    Box to{map.shift, map.shift};
    for (int row = 0; row < 3; ++row) {
        double sum = std::abs(map.shift[row]);
        for (int k = 0; k < 3; ++k) {
            const double m = map.linear[k][row];
            if (m == 0) continue;  // 0·∞ is no number
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
