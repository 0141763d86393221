#include "raytracer/render/noise_bound.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace deburr {
namespace {

// Side of a cell in pixels, and samples before it may end: with fewer, small bright details could be missed.
constexpr int cell_side = 8, min_cell_samples = 32;
// Noise in darker pixels is judged as if they were this bright: a hundredth of white is 10 % of the display's range.
constexpr double dark = 0.01;

int down(int i) { return i / cell_side * cell_side; }
int up(int i, int end) { return std::min((i + cell_side - 1) / cell_side * cell_side, end); }

// A copy of a cell's part of the window.
struct Cell {
    std::array<PixelSums, cell_side * cell_side> sums;
    std::array<LayerSums, cell_side * cell_side> layers;
    std::array<ColorSum, cell_side * cell_side> halves;
};

// The root mean square, in display values, of the difference between the averages of both halves of a cell's samples.
// The display's curve is taken to be a square root, so that d√I = dI / 2√I.
double seen_noise(const Cell& cell, std::size_t count) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double samples = cell.sums[i].samples;
        const Vec3 mean = cell.sums[i].color.value() / samples;
        const Vec3 error = (cell.halves[i].value() - (cell.sums[i].color - cell.halves[i]).value()) / samples;
        for (int k = 0; k < 3; ++k) sum += error[k] * error[k] / (4 * std::max(mean[k], dark));
    }
    return std::sqrt(sum / (3 * double(count)));
}

}  // namespace

Window grown_to_cells(const Window& w, int width, int height) {
    const int x = down(w.x), y = down(w.y);
    return {x, y, up(w.x + w.width, width) - x, up(w.y + w.height, height) - y};
}

void take_until_quiet(const Integrator& integrator, double noise, SampleRange pass, const Window& window,
                      const SampleArrays& arrays, TraceCounters& counters) {
    thread_local Cell cell;
    const bool may_end = pass.end >= min_cell_samples && std::has_single_bit(unsigned(pass.end));
    const bool is_half = pass.end >= min_cell_samples / 2 && std::has_single_bit(unsigned(pass.end));
    for (int top = 0; top < window.height; top += cell_side)
        for (int left = 0; left < window.width; left += cell_side) {
            const Window part{left, top, std::min(cell_side, window.width - left),
                              std::min(cell_side, window.height - top)};
            const std::size_t count = std::size_t(part.width) * std::size_t(part.height);
            const auto each = [&](auto work) {
                std::size_t here = 0;
                for (int y = 0; y < part.height; ++y)
                    for (int x = 0; x < part.width; ++x, ++here)
                        work(here, std::size_t(top + y) * std::size_t(window.width) + std::size_t(left + x));
            };
            each([&](std::size_t here, std::size_t there) {
                cell.sums[here] = arrays.sums[there];
                cell.halves[here] = arrays.halves[there];
                if (arrays.layers) cell.layers[here] = arrays.layers[there];
            });
            if (cell.sums[0].is_quiet) continue;
            integrator.take(pass, {window.x + left, window.y + top, part.width, part.height}, cell.sums.data(),
                            arrays.layers ? cell.layers.data() : nullptr, counters);
            const bool is_quiet = may_end && seen_noise(cell, count) <= noise;
            each([&](std::size_t here, std::size_t there) {
                cell.sums[here].is_quiet = is_quiet;
                arrays.sums[there] = cell.sums[here];
                if (is_half) arrays.halves[there] = cell.sums[here].color;
                if (arrays.layers) arrays.layers[there] = cell.layers[here];
            });
        }
}

}  // namespace deburr
