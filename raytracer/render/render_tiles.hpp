// Fills a film by tiles, in parallel (oneTBB).
//
// A tile is handed out whole, so that its rays can be traced together. A pixel's value is a function
// of its place alone, and counters are integers: the film and the sums do not depend on the number of
// threads, on the tiles or on the window.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>

#include "raytracer/image/film.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// Pixels of a side of a tile; at the right and lower edges of a window there may be fewer. Small
/// enough that "finish the tiles in hand" is soon done and that the last tiles do not leave other
/// threads idle for long; large enough that a tile costs much more than handing it out.
constexpr int tile_side = 16;

/// Tiles of a window, row by row from the top: the parts of an even grid over the whole picture that lie in it.
std::int64_t tile_count(const Window& window);
Window tile(const Window& window, std::int64_t index);

/// How work over tiles came to its end.
enum class TilesEnd {
    all,
    stopped,    // with tiles left
    abandoned,  // threads are still at work on tiles that nobody waits for
};

/// Asked every 20 ms whether no further tile shall start.
using Pause = std::function<bool()>;

/// Calls work(tile) for all tiles of a window, in parallel and from the top. Once `stop` is set or `pause` has said so
/// no further tile starts; those in hand are finished, or, if that takes longer than `grace`, abandoned. Their threads
/// go on until the process ends, with copies of `work`, which shares in the ownership of all that it uses; `stop`
/// outlives them. What `work` throws comes through.
TilesEnd for_each_tile(const Window& window, const std::function<void(const Window&)>& work,
                       const std::atomic<bool>& stop, const Pause& pause, std::chrono::milliseconds grace);

/// Sets all pixels of a block of the picture, row by row, and, unless null, their layers; a block is
/// a tile or a part of one. Called from many threads at once.
using BlockFunction =
    std::function<void(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters)>;

/// Told the number of pixels that were just finished; called from many threads at once.
using PixelsDone = std::function<void(std::int64_t pixels)>;

struct Rendering {
    Film film;  // film.complete is false if it was stopped with tiles left
    TraceCounters counters;
    std::int64_t pixels_done = 0;
    bool abandoned = false;  // threads are still at work on tiles that nobody waits for
};

/// Fills an empty film. Tiles start from the top. Once `stop` is set no further tile starts; those in hand are
/// finished. What `block` throws comes through.
Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done = {});

/// The same where nobody asks for an end.
Rendering render(Film film, const BlockFunction& block);

/// The same with an end soon after `stop` is set, however long a tile takes: those that are not finished after `grace`
/// are abandoned, and stay empty. Their threads go on until the process ends, with copies of `block`, which shares in
/// the ownership of all that it uses. `stop` outlives them; `done` is called no more after the return.
Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done,
                 std::chrono::milliseconds grace);

/// Whether threads are still at work on abandoned tiles: then the process ends by _exit(), or they would see what they
/// use destroyed.
bool any_tiles_abandoned();

}  // namespace deburr
