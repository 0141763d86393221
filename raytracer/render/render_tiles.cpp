#include "raytracer/render/render_tiles.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <future>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <thread>

namespace deburr {
namespace {

// The number of tiles that `pixels` pixels from `first` on touch along one axis.
std::int64_t tiles_along(int first, int pixels) {
    return pixels > 0 ? (std::int64_t(first) + pixels - 1) / tile_side - first / tile_side + 1 : 0;
}

// A rendering in progress; it outlives its caller if tiles are abandoned.
class Making {
public:
    Making(Film film, const BlockFunction& block, const PixelsDone& done)
        : block_(block), done_(done), window_(film.window), with_layers_(film.keeps_layers()) {
        result_.film = std::move(film);
    }

    void fill(const Window& part) {
        Work& work = work_.local();
        if (with_layers_) work.layers.resize(work.pixels.size());
        TraceCounters counters;
        block_(part, work.pixels.data(), with_layers_ ? work.layers.data() : nullptr, counters);
        const std::shared_lock one(film_);
        if (closed_) return;
        Film& film = result_.film;
        for (int y = 0; y < part.height; ++y)
            std::copy_n(&work.pixels[y * part.width], part.width, &film.at(part.x, part.y + y));
        if (with_layers_) film.set_layers(part, work.layers.data());
        const std::int64_t pixels = std::int64_t(part.width) * part.height;
        {
            const std::lock_guard lock(sums_);
            result_.counters += counters;
            result_.pixels_done += pixels;
        }
        if (done_) done_(pixels);
    }

    // The result so far; nothing is added to it afterwards.
    Rendering take() {
        const std::unique_lock all(film_);
        closed_ = true;
        result_.film.complete = result_.pixels_done == std::int64_t(window_.width) * std::int64_t(window_.height);
        return std::move(result_);
    }

    const Window& window() const { return window_; }

private:
    struct Work {
        std::array<Pixel, tile_side * tile_side> pixels;
        std::vector<PixelLayers> layers;
    };

    const BlockFunction block_;
    const PixelsDone done_;
    const Window window_;
    const bool with_layers_;
    tbb::enumerable_thread_specific<Work> work_;
    std::shared_mutex film_;  // shared: a tile is being added; exclusive: the result is taken
    std::mutex sums_;
    bool closed_ = false;
    Rendering result_;
};

std::atomic<bool> abandoned{false};

}  // namespace

std::int64_t tile_count(const Window& window) {
    return tiles_along(window.x, window.width) * tiles_along(window.y, window.height);
}

Window tile(const Window& window, std::int64_t index) {
    const std::int64_t columns = tiles_along(window.x, window.width);
    const int left = (window.x / tile_side + int(index % columns)) * tile_side;
    const int top = (window.y / tile_side + int(index / columns)) * tile_side;
    const int x = std::max(left, window.x), y = std::max(top, window.y);
    return {x, y, std::min(left + tile_side, window.x + window.width) - x,
            std::min(top + tile_side, window.y + window.height) - y};
}

namespace {

// The scheduler chooses when each call runs, but every call takes the next tile from the top, so that an interrupted
// picture has no holes above its lower edge.
void run_tiles(const Window& window, const std::function<void(const Window&)>& work, const std::atomic<bool>& stop,
               const std::atomic<bool>& pause) {
    std::atomic<std::int64_t> next{0};
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, tile_count(window)),
        [&](const tbb::blocked_range<std::int64_t>& tickets) {
            for (std::int64_t i = tickets.begin(); i != tickets.end(); ++i)
                if (!stop.load(std::memory_order_relaxed) && !pause.load(std::memory_order_relaxed))
                    work(tile(window, next++));
        },
        tbb::simple_partitioner{});
}

}  // namespace

TilesEnd for_each_tile(const Window& window, const std::function<void(const Window&)>& work,
                       const std::atomic<bool>& stop, const Pause& pause, std::chrono::milliseconds grace) {
    // Interval at which a stop is noticed.
    constexpr std::chrono::milliseconds poll_interval = std::chrono::milliseconds(20);
    const auto paused = std::make_shared<std::atomic<bool>>(false);
    const auto ended = [&] { return stop || *paused ? TilesEnd::stopped : TilesEnd::all; };
    std::packaged_task<void()> run([window, work, &stop, paused] { run_tiles(window, work, stop, *paused); });
    std::future<void> end = run.get_future();
    std::thread thread;
    try {
        thread = std::thread(std::move(run));
    } catch (const std::system_error&) {  // no thread is available, so this one does the work
        run_tiles(window, work, stop, *paused);
        return ended();
    }
    std::chrono::milliseconds waited(0);
    while (end.wait_for(poll_interval) != std::future_status::ready) {
        if (pause && !*paused && pause()) *paused = true;
        if (stop && waited >= grace) break;
        if (stop) waited += poll_interval;
    }
    if (end.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        thread.join();
        end.get();
        return ended();
    }
    thread.detach();
    abandoned = true;
    return TilesEnd::abandoned;
}

Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done) {
    Making making(std::move(film), block, done);
    run_tiles(
        making.window(), [&](const Window& part) { making.fill(part); }, stop, std::atomic<bool>(false));
    return making.take();
}

Rendering render(Film film, const BlockFunction& block) {
    const std::atomic<bool> never{false};
    return render(std::move(film), block, never, {});
}

Rendering render(Film film, const BlockFunction& block, const std::atomic<bool>& stop, const PixelsDone& done,
                 std::chrono::milliseconds grace) {
    const auto making = std::make_shared<Making>(std::move(film), block, done);
    const TilesEnd end = for_each_tile(
        making->window(), [making](const Window& part) { making->fill(part); }, stop, {}, grace);
    Rendering result = making->take();
    result.abandoned = end == TilesEnd::abandoned;
    return result;
}

bool any_tiles_abandoned() { return abandoned; }

}  // namespace deburr
