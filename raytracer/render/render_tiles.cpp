#include "raytracer/render/render_tiles.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace deburr {
namespace {

std::int64_t tiles_along(int pixels) { return (std::int64_t(pixels) + tile_side - 1) / tile_side; }

struct Work {
    std::array<Pixel, tile_side * tile_side> pixels_in_hand;
    std::vector<PixelLayers> layers_in_hand;
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

Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done) {
    Rendering result;
    result.film = std::move(film);
    const Window window = result.film.window;
    const bool with_layers = result.film.keeps_layers();
    const auto fill = [&](std::int64_t index, Work& work) {
        const Window part = tile(window, index);
        if (with_layers) work.layers_in_hand.resize(work.pixels_in_hand.size());
        block(part, work.pixels_in_hand.data(), with_layers ? work.layers_in_hand.data() : nullptr, work.counters);
        for (int y = 0; y < part.height; ++y)
            std::copy_n(&work.pixels_in_hand[std::size_t(y * part.width)], part.width,
                        &result.film.at(part.x, part.y + y));
        if (with_layers) result.film.set_layers(part, work.layers_in_hand.data());
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
    result.film.complete = result.pixels_done == std::int64_t(window.width) * std::int64_t(window.height);
    return result;
}

}  // namespace deburr
