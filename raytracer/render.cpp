#include "raytracer/render.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace deburr {
namespace {

std::int64_t tiles_along(int pixels) { return (std::int64_t(pixels) + tile_side - 1) / tile_side; }

struct Work {
    TraceCounters counters;
    std::int64_t pixels = 0;
};

}  // namespace

std::int64_t tile_count(const Window& window) { return tiles_along(window.width) * tiles_along(window.height); }

Window tile(const Window& window, std::int64_t index) {
    const std::int64_t columns = tiles_along(window.width);
    const int x = int(index % columns) * tile_side, y = int(index / columns) * tile_side;
    return {window.x + x, window.y + y, std::min(tile_side, window.width - x), std::min(tile_side, window.height - y)};
}

Rendering render(int width, int height, Window window, const BlockFunction& block,
                 const std::atomic<bool>& stop, const PixelsDone& done) {
    Rendering result;
    result.film = Film(width, height, window);
    const auto fill = [&](std::int64_t index, Work& work) {
        const Window part = tile(window, index);
        std::array<Pixel, tile_side * tile_side> seen;
        block(part, seen.data(), work.counters);
        for (int y = 0; y < part.height; ++y)
            std::copy_n(&seen[std::size_t(y * part.width)], part.width, &result.film.at(part.x, part.y + y));
        const std::int64_t pixels = std::int64_t(part.width) * part.height;
        work.pixels += pixels;
        if (done) done(pixels);
    };

    // The scheduler hands out tickets in an order of its own; whoever holds one takes the next tile
    // from the top, so that an interrupted picture has no holes above its lower edge.
    std::atomic<std::int64_t> next{0};
    tbb::enumerable_thread_specific<Work> work;
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, tile_count(window)),
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
