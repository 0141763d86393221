#include "bench/density_grid.hpp"

#include <algorithm>
#include <stdexcept>

namespace deburr::bench {
namespace {

// The values of a node along a row: a single one if constant, else one for each sample.
struct Row {
    bool constant = false;
    float value = 0;
    std::vector<float> values;
};

void profile_row(const HalfSpace& h, Vec3 start, double step, int count, Row& row) {
    const double a0 = h.distance(start) / h.radius, rate = h.normal.x * step / h.radius;
    const double a1 = a0 + rate * (count - 1);
    row.constant = std::min(a0, a1) >= 1 || std::max(a0, a1) <= -1 || rate == 0;
    if (row.constant) {
        row.value = float(profile(a0));
        return;
    }
    row.values.resize(std::size_t(count));
    float* out = row.values.data();
    const float start_alpha = float(a0), step_alpha = float(rate);
    for (int i = 0; i < count; ++i) {
        const float a = std::min(1.f, std::max(-1.f, start_alpha + step_alpha * float(i)));
        out[i] = 0.5f + a * (a * a - 3) * 0.25f;
    }
}

template <class Of>
void combine_rows(Row& a, Row& b, int count, Row& out, Of of) {
    out.constant = a.constant && b.constant;
    if (out.constant) {
        out.value = of(a.value, b.value);
        return;
    }
    out.values.resize(std::size_t(count));
    float* to = out.values.data();
    const float *from_a = a.values.data(), *from_b = b.values.data();
    const float value_a = a.value, value_b = b.value;
    if (a.constant)
        for (int i = 0; i < count; ++i) to[i] = of(value_a, from_b[i]);
    else if (b.constant)
        for (int i = 0; i < count; ++i) to[i] = of(from_a[i], value_b);
    else
        for (int i = 0; i < count; ++i) to[i] = of(from_a[i], from_b[i]);
}

void product_rows(Row& a, Row& b, int count, Row& out) {
    if ((a.constant && a.value == 0) || (b.constant && b.value == 0)) {
        out.constant = true;
        out.value = 0;
        return;
    }
    combine_rows(a, b, count, out, [](float x, float y) { return x * y; });
}

}  // namespace

DensityGrid density_grid(const DensityTree& tree, const Box& box, double step) {
    DensityGrid grid;
    grid.origin = box.lo;
    grid.step = step;
    for (int k = 0; k < 3; ++k) grid.size[k] = int(std::ceil((box.hi[k] - box.lo[k]) / step)) + 1;
    const int count = grid.size[0];
    grid.values.resize(std::size_t(count) * std::size_t(grid.size[1]) * std::size_t(grid.size[2]));
    std::vector<Row> rows(tree.nodes.size());
    float* out = grid.values.data();
    for (int z = 0; z < grid.size[2]; ++z)
        for (int y = 0; y < grid.size[1]; ++y, out += count) {
            const Vec3 start = grid.origin + step * Vec3(0, y, z);
            for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
                const TreeNode& n = tree.nodes[i];
                Row& row = rows[i];
                const auto at = [&](int c) -> Row& { return rows[c]; };
                switch (n.op) {
                    case Op::half_space: profile_row(tree.half_spaces[n.a], start, step, count, row); break;
                    case Op::product: product_rows(at(n.a), at(n.b), count, row); break;
                    case Op::sum:
                        combine_rows(at(n.a), at(n.b), count, row, [](float a, float b) { return a + b; });
                        break;
                    case Op::difference:
                        combine_rows(at(n.a), at(n.b), count, row, [](float a, float b) { return a - b; });
                        break;
                    default: throw std::logic_error("density_grid: not the papers' arithmetic");
                }
            }
            const Row& last = rows.back();
            if (last.constant)
                std::fill(out, out + count, last.value);
            else
                std::copy(last.values.begin(), last.values.begin() + count, out);
        }
    return grid;
}

}  // namespace deburr::bench
