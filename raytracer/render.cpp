#include "raytracer/render.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace deburr {
namespace {

// Small enough that "finish the tiles in hand" is soon done and that the last tiles do not leave
// other threads idle for long; large enough that a tile costs much more than handing it out.
constexpr int tile_side = 16;

struct Work {
    TraceCounters counters;
    std::int64_t pixels = 0;
};

}  // namespace

Rendering render(int width, int height, Window window, const PixelFunction& pixel,
                 const std::atomic<bool>& stop, const PixelsDone& done) {
    Rendering result;
    result.film = Film(width, height, window);
    const std::int64_t columns = (window.width + tile_side - 1) / tile_side;
    const std::int64_t rows = (window.height + tile_side - 1) / tile_side;

    const auto fill = [&](std::int64_t tile, Work& work) {
        const int x0 = window.x + int(tile % columns) * tile_side;
        const int y0 = window.y + int(tile / columns) * tile_side;
        const int x1 = std::min(x0 + tile_side, window.x + window.width);
        const int y1 = std::min(y0 + tile_side, window.y + window.height);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) result.film.at(x, y) = pixel(x, y, work.counters);
        const std::int64_t pixels = std::int64_t(x1 - x0) * (y1 - y0);
        work.pixels += pixels;
        if (done) done(pixels);
    };

    // The scheduler hands out tickets in an order of its own; whoever holds one takes the next tile
    // from the top, so that an interrupted picture has no holes above its lower edge.
    std::atomic<std::int64_t> next{0};
    tbb::enumerable_thread_specific<Work> work;
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, columns * rows),
        [&](const tbb::blocked_range<std::int64_t>& tickets) {
            Work& mine = work.local();
            for (std::int64_t i = tickets.begin(); i != tickets.end(); ++i)
                if (!stop.load(std::memory_order_relaxed)) fill(next++, mine);
        },
        tbb::simple_partitioner{});

    for (const Work& part : work) {
        result.counters += part.counters;
        result.pixels_done += part.pixels;
    }
    result.film.complete =
        result.pixels_done == std::int64_t(window.width) * std::int64_t(window.height);
    return result;
}

}  // namespace deburr
