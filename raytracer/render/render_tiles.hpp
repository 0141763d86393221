// Renders a film by tiles, in parallel (oneTBB).
//
// A tile is rendered by one thread, so that its rays can be traced together. A pixel's value is a function of its
// position only, and counters are integers, so film and counters do not depend on the number of threads, on the tiles
// or on the window.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

#include "raytracer/image/film.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// The side of a tile in pixels (less at the right and lower edges of a window). Small enough that the tiles in hand
/// end soon and that the last ones do not leave other threads idle for long; large enough that its rendering costs much
/// more than its scheduling.
constexpr int tile_side = 16;

/// The tiles of a window, row by row from the top: the parts in it of a regular grid over the whole picture.
std::int64_t tile_count(const Window& window);
Window tile(const Window& window, std::int64_t index);

/// The way in which work over tiles ended.
enum class TilesEnd {
    all,
    stopped,    // by request, with tiles left
    abandoned,  // threads are still working on tiles that nobody waits for
};

/// Asked every 20 ms; true means that no further tile starts.
using Pause = std::function<bool()>;

/// Calls work(tile) for all tiles of a window, in parallel and from the top. Once `stop` is set or `pause` returns
/// true, no further tile starts; those in hand are finished or, if that takes longer than `grace`, abandoned: their
/// threads continue until the process ends, with copies of `work`, which must share the ownership of all that it uses,
/// and `stop` must outlive them. Exceptions of `work` are passed on.
TilesEnd for_each_tile(const Window& window, const std::function<void(const Window&)>& work,
                       const std::atomic<bool>& stop, const Pause& pause, std::chrono::milliseconds grace);

/// Sets the pixels of a block (a tile or a part of one), row by row, and their layers unless null. Called from many
/// threads.
using BlockFunction =
    std::function<void(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters)>;

/// Told the number of pixels that were just finished; called from many threads.
using PixelsDone = std::function<void(std::int64_t pixels)>;

/// The result of render().
struct Rendering {
    Film film;  // film.complete is false if it was stopped with tiles left
    TraceCounters counters;
    std::int64_t pixels_done = 0;
    bool abandoned = false;  // threads are still working on tiles that nobody waits for
};

/// Fills an empty film, from the top. Once `stop` is set, no further tile starts, and those in hand are finished.
/// Exceptions of `block` are passed on.
Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done = {});

/// As above, without a way to stop.
Rendering render(Film film, const BlockFunction& block);

/// As above, but returns soon after `stop` is set, however long a tile takes: tiles that are not finished after `grace`
/// are abandoned and stay empty. Their threads continue until the process ends, with copies of `block`, which must
/// share the ownership of all that it uses; `stop` must outlive them. `done` is not called after the return.
Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done,
                 std::chrono::milliseconds grace);

/// Whether threads are still working on abandoned tiles. Then the process must end by _exit(), or they would use
/// destroyed objects.
bool any_tiles_abandoned();

}  // namespace deburr
