// Rendering in tiles: each pixel once, kept layers, counters, stops and exceptions.
#include "raytracer/render/render_tiles.hpp"

#include <tbb/global_control.h>

#include <chrono>
#include <thread>

#include "catch.hpp"

using namespace deburr;

namespace {

const std::atomic<bool> never{false};

void places(const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
    for (int y = block.y; y < block.y + block.height; ++y)
        for (int x = block.x; x < block.x + block.width; ++x) {
            ++counters.rays;
            counters.evaluations += std::uint64_t(x);
            *pixels++ = {.color = {double(x), double(y), 1}};
            if (layers)
                *layers++ = {.position = {double(x), 0, double(y)}, .id = std::uint32_t(1000 * y + x), .solids = {}};
        }
}

}  // namespace

TEST_CASE("every pixel of the window is rendered once, whatever its size") {
    for (const Window window : {Window{0, 0, 1, 1}, Window{0, 0, 16, 16}, Window{3, 5, 17, 33}, Window{90, 40, 10, 10},
                                Window{0, 0, 100, 50}}) {
        CAPTURE(window.x, window.y, window.width, window.height);
        std::atomic<std::int64_t> reported{0};
        const Rendering r = render(Film(100, 50, window), places, never, [&](std::int64_t n) { reported += n; });
        const auto pixels = std::uint64_t(window.width) * std::uint64_t(window.height);
        CHECK(r.film.complete);
        CHECK(r.film.window == window);
        CHECK(r.pixels_done == std::int64_t(pixels));
        CHECK(reported == std::int64_t(pixels));
        CHECK(r.counters.rays == pixels);
        for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x) REQUIRE(r.film.at(x, y).color == Vec3(x, y, 1));
    }
}

TEST_CASE("a film keeps the layers that were asked for, and no others") {
    for (const std::vector<ImageLayer>& asked :
         {std::vector<ImageLayer>{}, {ImageLayer::position}, {ImageLayer::id, ImageLayer::position, ImageLayer::id}}) {
        const Window window{3, 5, 17, 33};
        const Rendering r = render(Film(100, 50, window, asked), places, never);
        for (const ImageLayer layer : all_layers()) {
            const bool kept = std::count(asked.begin(), asked.end(), layer) > 0;
            CHECK(r.film.keeps(layer) == kept);
            if (!kept) CHECK_THROWS_AS(r.film.layer(layer), std::logic_error);
        }
        CHECK(r.film.keeps_layers() == !asked.empty());
        for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x) {
                const std::size_t i = r.film.index(x, y);
                REQUIRE(r.film.pixels[i].color == Vec3(x, y, 1));
                if (r.film.keeps(ImageLayer::position))
                    REQUIRE(r.film.layer(ImageLayer::position).vec(i) == Vec3(x, 0, y));
                if (r.film.keeps(ImageLayer::id)) REQUIRE(r.film.layer(ImageLayer::id).at(i) == 1000 * y + x);
            }
    }
    CHECK(Film::bytes_per_pixel({}) == 32);
    CHECK(Film::bytes_per_pixel({ImageLayer::id, ImageLayer::position, ImageLayer::id}) == 64);
    CHECK(Film::bytes_per_pixel(all_layers()) == 248);
}

TEST_CASE("sums of counters do not depend on the number of threads") {
    std::uint64_t evaluations = 0;
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Rendering r = render(Film(300, 200, {0, 0, 300, 200}), places, never);
        if (threads == 1) evaluations = r.counters.evaluations;
        CHECK(r.counters.evaluations == evaluations);
    }
    CHECK(evaluations == 200u * 300u * 299u / 2u);
}

TEST_CASE("a stop lets the tiles in hand finish and starts no other") {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    std::atomic<bool> stop{false};
    const Rendering r = render(
        Film(100, 100, {0, 0, 100, 100}, {ImageLayer::z, ImageLayer::id}),
        [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
            if (block.x == 16) stop = true;  // the second tile of the first row
            places(block, pixels, layers, counters);
        },
        stop);
    CHECK_FALSE(r.film.complete);
    CHECK(r.pixels_done == 2 * 16 * 16);
    CHECK(r.film.at(31, 15).color == Vec3(31, 15, 1));
    CHECK(r.film.at(32, 0).color == Vec3(0.0));
    CHECK(r.film.at(32, 0).alpha == 0);
    CHECK(r.film.layer(ImageLayer::id).at(r.film.index(31, 15)) == 15'031);
    CHECK(r.film.layer(ImageLayer::id).at(r.film.index(32, 0)) == 0);
    CHECK(r.film.layer(ImageLayer::z).at(r.film.index(32, 0)) == infinity);
}

TEST_CASE("a stop before the first tile leaves an empty film") {
    const std::atomic<bool> stop{true};
    const Rendering r = render(Film(8, 8, {0, 0, 8, 8}), places, stop);
    CHECK_FALSE(r.film.complete);
    CHECK(r.pixels_done == 0);
}

TEST_CASE("what a block throws comes through") {
    const auto thrower = [](const Window& block, Pixel*, PixelLayers*, TraceCounters&) {
        if (block.x == 32) throw std::runtime_error("broken");
    };
    CHECK_THROWS_AS(render(Film(64, 64, {0, 0, 64, 64}), thrower, never), std::runtime_error);
}

TEST_CASE("a tile that does not end is abandoned once the grace period is over") {
    static std::atomic<bool> stop{false}, go_on{false};  // static, as the abandoned thread still reads them
    static std::atomic<int> left{0};
    const auto shade = [](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
        if (block.x == 16 && block.y == 0) {
            stop = true;
            while (!go_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ++left;
        }
        places(block, pixels, layers, counters);
    };
    const Rendering r =
        render(Film(100, 100, {0, 0, 100, 100}, {ImageLayer::z}), shade, stop, {}, std::chrono::milliseconds(50));
    CHECK(r.abandoned);
    CHECK(any_tiles_abandoned());
    CHECK(left == 0);
    CHECK_FALSE(r.film.complete);
    CHECK(r.pixels_done >= 16 * 16);
    CHECK(r.film.at(15, 15).color == Vec3(15, 15, 1));
    CHECK(r.film.at(16, 0).alpha == 0);
    go_on = true;
    while (left == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(r.film.at(16, 0).color == Vec3(0.0));
}

TEST_CASE("without a stop the grace period changes nothing") {
    const Rendering a = render(Film(100, 50, {0, 0, 100, 50}), places, never);
    const Rendering b = render(Film(100, 50, {0, 0, 100, 50}), places, never, {}, std::chrono::milliseconds(0));
    CHECK(b.film.complete);
    CHECK_FALSE(b.abandoned);
    CHECK(b.counters.evaluations == a.counters.evaluations);
    for (std::size_t i = 0; i < a.film.pixels.size(); ++i) REQUIRE(a.film.pixels[i].color == b.film.pixels[i].color);
    const auto slow = [](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        places(block, pixels, layers, counters);
    };
    CHECK(render(Film(16, 16, {0, 0, 16, 16}), slow, never, {}, std::chrono::milliseconds(0)).film.complete);
    const auto thrower = [](const Window&, Pixel*, PixelLayers*, TraceCounters&) { throw std::bad_alloc(); };
    CHECK_THROWS_AS(render(Film(64, 64, {0, 0, 64, 64}), thrower, never, {}, std::chrono::milliseconds(0)),
                    std::bad_alloc);
}
