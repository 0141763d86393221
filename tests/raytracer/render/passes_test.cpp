// Passes: the picture after n samples depends on n alone and not on how the samples were taken.
#include "raytracer/render/passes.hpp"

#include <tbb/global_control.h>

#include <bit>
#include <random>

#include "catch.hpp"
#include "raytracer/render/analytic_tracer.hpp"

using namespace deburr;

namespace {

constexpr std::chrono::milliseconds no_grace(0);
const std::vector<ImageLayer> layers_asked = {ImageLayer::position, ImageLayer::albedo, ImageLayer::id,
                                              ImageLayer::cryptomatte};

// A sphere over a floor, 45 × 37 pixels.
struct Small {
    Scene scene = probe(material_of(Material::Kind::plastic, Vec3(0.6, 0.5, 0.3), 0.3));
    AnalyticTracer tracer{
        {{AnalyticShape::Kind::plane, Vec3(0.0), {0, 1, 0}, 0, 0}, {AnalyticShape::Kind::sphere, {0, 1, 0}, {}, 1, 0}}};
    RenderSettings settings{45, 37, 1, 3};

    Small() {
        scene.camera = {{0, 3, 6}, {0, 0, 0}, {0, 1, 0}, 50};
        scene.background.sky = true;
        settings.integrator = IntegratorKind::path;
        settings.cost = false;
    }
    std::shared_ptr<const Integrator> integrator(int spp) {
        settings.spp = spp;
        return std::make_shared<const Integrator>(scene, tracer, settings);
    }
    Passes passes(int spp, Window window = {0, 0, 45, 37}) {
        return {{45, 37, window, layers_asked, {0, spp}, settings.noise}, integrator(spp)};
    }
    // The picture rendered in one go.
    Film film(int spp, Window window = {0, 0, 45, 37}) {
        const auto all = integrator(spp);
        return render(Film(45, 37, window, layers_asked),
                      [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
                          all->block(block, pixels, layers, counters);
                      })
            .film;
    }
};

void check_same(const Film& a, const Film& b) {
    REQUIRE(a.pixels.size() == b.pixels.size());
    bool same = true;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        same = same && a.pixels[i].color == b.pixels[i].color && a.pixels[i].alpha == b.pixels[i].alpha;
        for (const ImageLayer layer : layers_asked)
            for (int k = 0; k < components(layer); ++k)
                same = same && a.layer(layer).at(i, k) == b.layer(layer).at(i, k);
    }
    CHECK(same);
}

}  // namespace

TEST_CASE("passes are 1, 1, 2, 4, … 32, 32, …, and every power of two ends one") {
    for (const int end : {1, 2, 50, 64, 1000}) {
        std::vector<int> ends;
        for (SampleRange pass = next_pass({0, end}, 0); pass.first < end; pass = next_pass({0, end}, pass.end)) {
            CHECK(pass.first == (ends.empty() ? 0 : ends.back()));
            CHECK(pass.end > pass.first);
            CHECK(pass.end - pass.first <= 32);
            ends.push_back(pass.end);
        }
        CHECK(ends.back() == end);
        for (int power = 1; power <= end; power *= 2) CHECK(std::count(ends.begin(), ends.end(), power) == 1);
    }
    CHECK(next_pass({100, 200}, 0) == SampleRange{100, 101});
    CHECK(next_pass({100, 200}, 104) == SampleRange{104, 108});
    CHECK(next_pass({100, 200}, 200) == SampleRange{200, 200});
}

TEST_CASE("exact sums depend on neither order nor grouping, and are right to the last bit that they keep") {
    std::mt19937_64 random(5);
    std::vector<double> numbers;
    for (int i = 0; i < 10'000; ++i) {  // in statements, as arguments are evaluated in any order
        const int exponent = int(random() % 40) - 70;
        numbers.push_back(std::ldexp(double(random() >> 11), exponent));
    }
    ExactSum forward, backward, halves[2];
    double plain = 0, plain_backward = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        forward += numbers[i];
        plain += numbers[i];
        backward += numbers[numbers.size() - 1 - i];
        plain_backward += numbers[numbers.size() - 1 - i];
        halves[i % 2] += numbers[i];
    }
    halves[0] += halves[1];
    CHECK(forward == backward);
    CHECK(forward == halves[0]);
    CHECK(plain != plain_backward);  // rounding shows in plain sums
    CHECK(std::abs(forward.value() / plain - 1) < 1e-12);
    ExactSum third;
    for (int i = 0; i < 3; ++i) third += 1.0 / 3;
    CHECK(third.value() == Approx(1).epsilon(1e-17));
    ExactSum bright;
    for (int i = 0; i < 1 << 20; ++i) bright += 1e300;
    CHECK(bright.value() == 0x1p66);  // saturates
}

TEST_CASE("after every pass the film is the picture of that many samples") {
    Small small;
    const std::atomic<bool> never{false};
    for (const Window window : {Window{0, 0, 45, 37}, Window{7, 3, 20, 30}}) {
        Passes passes = small.passes(37, window);
        while (!passes.finished()) {
            CHECK(passes.go_on(never, {}, {}, no_grace) == TilesEnd::all);
            check_same(passes.film(), small.film(passes.samples_of_all(), window));
        }
        CHECK(passes.samples_of_all() == 37);
        CHECK(passes.work_done() == passes.work());
    }
}

TEST_CASE("a pass that is paused anywhere leaves the picture of the pass before, and goes on to the same end") {
    Small small;
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
    for (const double noise : {0.0, 0.03}) {
        small.settings.noise = noise;
        std::vector<Film> after(101);  // indexed by the number of samples
        Passes straight = small.passes(100);
        const std::atomic<bool> never{false};
        while (!straight.finished()) {
            REQUIRE(straight.go_on(never, {}, {}, no_grace) == TilesEnd::all);
            after[std::size_t(straight.samples_of_all())] = straight.film();
        }
        std::mt19937 random(9);
        Passes passes = small.passes(100);
        int stops = 0;
        for (int calls = 0; calls < 1000 && !passes.finished(); ++calls) {
            // The pass is stopped after a random number of tiles.
            std::atomic<bool> stop{false};
            std::atomic<int> left{int(random() % 12)};
            const TilesEnd end = passes.go_on(
                stop, {}, [&](std::int64_t) { stop = stop || left-- <= 0; }, std::chrono::seconds(60));
            stops += end == TilesEnd::stopped;
            if (passes.samples_of_all() == 0) continue;
            check_same(passes.film(), after[std::size_t(passes.samples_of_all())]);
        }
        check_same(passes.film(), after[100]);
        CHECK(stops > 5);
    }
}

TEST_CASE("the first pass under way leaves pixels with a sample, and empty ones") {
    Small small;
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    Passes passes = small.passes(8);
    std::atomic<bool> stop{false};
    passes.go_on(
        stop, {}, [&](std::int64_t) { stop = true; }, std::chrono::seconds(60));
    CHECK(passes.samples_of_all() == 0);
    CHECK(passes.pixels_begun() == 16 * 16);
    const Film& film = passes.film();
    const Film one = small.film(1);
    CHECK_FALSE(film.complete);
    CHECK(film.at(15, 15).color == one.at(15, 15).color);
    CHECK(film.at(16, 15).color == Vec3(0.0));
    CHECK(film.layer(ImageLayer::id).at(film.index(16, 15)) == 0);
}
