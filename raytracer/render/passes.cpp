#include "raytracer/render/passes.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>

#include "raytracer/render/noise_bound.hpp"

namespace deburr {
namespace {

// A copy of a tile's part of the window, with room for its pixels.
struct TileWork {
    std::vector<PixelSums> sums;
    std::vector<LayerSums> layers;
    std::vector<ColorSum> halves;
    std::vector<Pixel> pixels;
    std::vector<PixelLayers> pixel_layers;
};

Window common(const Window& a, const Window& b) {
    const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
    return {x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

// The state of a rendering; it outlives its owner if tiles are abandoned.
struct Passes::Store {
    Settings settings;
    std::shared_ptr<const Integrator> integrator;
    PassState state;
    Film film;
    SampleRange pass;  // the pass under way
    TraceCounters counters;
    std::array<std::uint64_t, 8> counter_list{};  // `counters` as a list, for files
    PixelsDone done;
    std::shared_mutex tiles;  // shared: a tile is being added; exclusive: the state must not change
    std::mutex counting;
    bool closed = false;
    tbb::enumerable_thread_specific<TileWork> work;

    std::int64_t tile_index(const Window& part) const {
        const Window& w = state.window;
        const std::int64_t columns = tile_count({w.x, w.y, w.width, 1});
        return std::int64_t(part.y / tile_side - w.y / tile_side) * columns + (part.x / tile_side - w.x / tile_side);
    }

    template <class All, class Part>
    void copy_out(const Window& part, const All& all, Part& here) const {
        here.resize(std::size_t(part.width) * std::size_t(part.height));
        for (int y = 0; y < part.height; ++y)
            std::copy_n(&all[index(part.x, part.y + y)], part.width, &here[std::size_t(y) * std::size_t(part.width)]);
    }
    template <class All, class Part>
    void copy_in(const Window& part, const Part& here, All& all) const {
        for (int y = 0; y < part.height; ++y)
            std::copy_n(&here[std::size_t(y) * std::size_t(part.width)], part.width, &all[index(part.x, part.y + y)]);
    }
    std::size_t index(int x, int y) const {
        return std::size_t(y - state.window.y) * std::size_t(state.window.width) + std::size_t(x - state.window.x);
    }

    // Shows the averages of a tile's sums in the film.
    void show(const Window& part, TileWork& mine) {
        const Window shown = common(part, film.window);
        if (shown.width <= 0 || shown.height <= 0) return;
        const bool layers = film.keeps_layers();
        mine.pixel_layers.resize(layers ? std::size_t(shown.width) * std::size_t(shown.height) : 0);
        std::size_t i = 0;
        for (int y = shown.y; y < shown.y + shown.height; ++y)
            for (int x = shown.x; x < shown.x + shown.width; ++x, ++i) {
                const PixelSums& pixel = state.sums[index(x, y)];
                film.at(x, y) = mean(pixel);
                if (layers) mine.pixel_layers[i] = mean(state.layers[index(x, y)], pixel.samples);
            }
        if (layers) film.set_layers(shown, mine.pixel_layers.data());
    }

    void take(const Window& part) {
        int& taken = state.taken[std::size_t(tile_index(part))];
        if (taken == pass.end) return;
        TileWork& mine = work.local();
        copy_out(part, state.sums, mine.sums);
        if (!state.layers.empty()) copy_out(part, state.layers, mine.layers);
        if (!state.halves.empty()) copy_out(part, state.halves, mine.halves);
        const SampleArrays arrays{mine.sums.data(), state.layers.empty() ? nullptr : mine.layers.data(),
                                  state.halves.empty() ? nullptr : mine.halves.data()};
        TraceCounters here;
        if (settings.noise > 0)
            take_until_quiet(*integrator, settings.noise, pass, part, arrays, here);
        else
            integrator->take(pass, part, arrays.sums, arrays.layers, here);

        const std::shared_lock one(tiles);
        if (closed) return;
        if (pass.first > state.samples.first) show(part, mine);
        const std::int64_t before = work_of(part);
        copy_in(part, mine.sums, state.sums);
        if (!state.layers.empty()) copy_in(part, mine.layers, state.layers);
        if (!state.halves.empty()) copy_in(part, mine.halves, state.halves);
        taken = pass.end;
        const std::int64_t gained = work_of(part) - before;
        {
            const std::lock_guard lock(counting);
            counters += here;
        }
        if (done) done(gained);
    }

    // Pixels times samples of a tile that are taken or not needed.
    std::int64_t work_of(const Window& part) const {
        const int all = state.samples.end - state.samples.first;
        std::int64_t sum = 0;
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x) {
                const PixelSums& pixel = state.sums[index(x, y)];
                sum += pixel.is_quiet ? all : std::int64_t(pixel.samples);
            }
        return sum;
    }
};

Passes::Passes(const Settings& settings, std::shared_ptr<const Integrator> integrator)
    : store_(std::make_shared<Store>()) {
    Store& s = *store_;
    s.settings = settings;
    s.integrator = std::move(integrator);
    s.film = Film(settings.width, settings.height, settings.window, settings.layers);
    const bool noise = settings.noise > 0;
    s.state.samples = settings.samples;
    s.state.window = noise ? grown_to_cells(settings.window, settings.width, settings.height) : settings.window;
    const std::size_t pixels = std::size_t(s.state.window.width) * std::size_t(s.state.window.height);
    s.state.sums.resize(pixels);
    s.state.layers.resize(settings.layers.empty() ? 0 : pixels);
    s.state.halves.resize(noise ? pixels : 0);
    s.state.taken.assign(std::size_t(tile_count(s.state.window)), settings.samples.first);
}

Passes::~Passes() = default;
Passes::Passes(Passes&&) noexcept = default;

TilesEnd Passes::go_on(const std::atomic<bool>& stop, const Pause& pause, const PixelsDone& done,
                       std::chrono::milliseconds grace) {
    Store& s = *store_;
    s.pass = next_pass(s.state.samples, *std::min_element(s.state.taken.begin(), s.state.taken.end()));
    s.pass.end = std::min(s.pass.end, s.pass.first + s.settings.max_pass);
    s.done = done;
    const TilesEnd end = for_each_tile(
        s.state.window, [store = store_](const Window& part) { store->take(part); }, stop, pause, grace);
    if (end == TilesEnd::abandoned) {
        const std::unique_lock all(s.tiles);
        s.closed = true;
    }
    s.done = {};
    return end;
}

bool Passes::finished() const {
    const PassState& state = store_->state;
    return std::all_of(state.taken.begin(), state.taken.end(), [&](int taken) { return taken == state.samples.end; });
}

int Passes::samples_of_all() const {
    const PassState& state = store_->state;
    return *std::min_element(state.taken.begin(), state.taken.end()) - state.samples.first;
}

std::int64_t Passes::pixels_begun() const {
    const Store& s = *store_;
    std::int64_t pixels = 0;
    for (std::int64_t i = 0; i < std::int64_t(s.state.taken.size()); ++i)
        if (s.state.taken[std::size_t(i)] > s.state.samples.first) {
            const Window part = common(tile(s.state.window, i), s.film.window);
            if (part.width > 0 && part.height > 0) pixels += std::int64_t(part.width) * part.height;
        }
    return pixels;
}

// Tiles that are already ahead in the pass under way are shown as they were before it.
const Film& Passes::film() const {
    Store& s = *store_;
    const int least = *std::min_element(s.state.taken.begin(), s.state.taken.end());
    const bool first = least == s.state.samples.first;
    tbb::parallel_for(std::size_t(0), s.state.taken.size(), [&](std::size_t i) {
        if (first || s.state.taken[i] == least) s.show(tile(s.state.window, std::int64_t(i)), s.work.local());
    });
    s.film.complete = finished();
    return s.film;
}

TraceCounters Passes::counters() const { return store_->counters; }

double Passes::work_done() const { return double(store_->work_of(store_->state.window)); }

double Passes::work() const {
    const PassState& state = store_->state;
    return double(state.sums.size()) * (state.samples.end - state.samples.first);
}

namespace {

// Writes numbers as they are in memory.
class Writer {
public:
    template <class List>
    void add(const List& list) {
        bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
    }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

class Reader {
public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}
    template <class List>
    void take(List& list) {
        const std::size_t size = list.size() * sizeof(list[0]);
        if (size > left_.size()) throw std::length_error("the bytes end early");
        if (size > 0) std::memcpy(static_cast<void*>(list.data()), left_.data(), size);
        left_.remove_prefix(size);
    }
    bool at_end() const { return left_.empty(); }

private:
    std::string_view left_;
};

// Passes everything that is saved to `with`, in a fixed order.
template <class Archive, class Store>
void exchange(Archive&& with, Store& store, std::vector<double>& planes) {
    with(store.state.taken);
    with(store.state.sums);
    with(store.state.layers);
    with(store.state.halves);
    // The film's values of tiles that are ahead in the pass under way.
    with(store.film.pixels);
    with(planes);
    with(store.counter_list);
}

}  // namespace

std::string Passes::bytes() const {
    Store& s = *store_;
    film();
    Writer writer;
    std::vector<double> planes = s.film.layer_values();
    s.counter_list = {s.counters.rays,      s.counters.shadow_rays, s.counters.instances, s.counters.cells,
                      s.counters.flat_hits, s.counters.segments,    s.counters.splits,    s.counters.evaluations};
    exchange([&](const auto& list) { writer.add(list); }, s, planes);
    return writer.take();
}

bool Passes::restore(std::string_view bytes) {
    Store& s = *store_;
    std::size_t size = 0;
    std::vector<double> planes = s.film.layer_values();
    exchange([&](const auto& list) { size += list.size() * sizeof(list[0]); }, s, planes);
    if (bytes.size() != size) return false;
    Reader reader(bytes);
    exchange([&](auto& list) { reader.take(list); }, s, planes);
    s.film.set_layer_values(planes);
    const auto& c = s.counter_list;
    s.counters = {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]};
    return true;
}

const PixelSums& Passes::sums_at(std::size_t i) const {
    const Window& w = store_->film.window;
    return store_->state.sums[store_->index(w.x + int(i % std::size_t(w.width)), w.y + int(i / std::size_t(w.width)))];
}

const LayerSums& Passes::layers_at(std::size_t i) const {
    const Window& w = store_->film.window;
    return store_->state
        .layers[store_->index(w.x + int(i % std::size_t(w.width)), w.y + int(i / std::size_t(w.width)))];
}

double Passes::bytes_per_pixel(const Settings& settings) {
    return Film::bytes_per_pixel(settings.layers) + sizeof(PixelSums) +
           (settings.layers.empty() ? 0.0 : double(sizeof(LayerSums))) +
           (settings.noise > 0 ? double(sizeof(ColorSum)) : 0.0);
}

}  // namespace deburr
