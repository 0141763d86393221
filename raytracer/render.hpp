// Fills a film by tiles, in parallel (oneTBB).
//
// A pixel's value is a function of its place alone, and counters are integers: the film and the
// sums do not depend on the number of threads, on the tiles or on the window.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

#include "raytracer/film.hpp"
#include "raytracer/ray_tracer.hpp"

namespace deburr {

/// Colour and layers of pixel (x, y) of the whole picture; called from many threads at once.
using PixelFunction = std::function<Pixel(int x, int y, TraceCounters& counters)>;

/// Told the number of pixels that were just finished; called from many threads at once.
using PixelsDone = std::function<void(std::int64_t pixels)>;

struct Rendering {
    Film film;  // film.complete is false if it was stopped with tiles left
    TraceCounters counters;
    std::int64_t pixels_done = 0;
};

/// Tiles start from the top. Once `stop` is set no further tile starts; those in hand are finished.
/// What `pixel` throws comes through.
Rendering render(int width, int height, Window window, const PixelFunction& pixel,
                 const std::atomic<bool>& stop, const PixelsDone& done = {});

}  // namespace deburr
