// deburr render SCENE -o FILE …: a picture, exact from the implicit surfaces.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/render_pictures.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/image/denoise.hpp"
#include "raytracer/image/exposure.hpp"
#include "raytracer/image/surroundings_file.hpp"
#include "raytracer/render/passes.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/interrupt.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

using Clock = std::chrono::steady_clock;

// Of a mesh's edges, in pixels: fine, and still black.
constexpr double line_width = 1;
// What tiles in hand are given once a stop is asked for.
constexpr std::chrono::milliseconds grace(300);

bool is_for_screen(const std::string& path) { return image_kind(path) == ImageKind::display; }

void write_statistics(const RenderOptions& o, const RunStatistics& run) {
    if (o.stats) fmt::print("{}", statistics_table(run));
    if (!o.stats_json.empty()) write_whole_file(o.stats_json, statistics_json(run));
}

// One picture on its way.
class RenderRun {
public:
    RenderRun(const RenderOptions& options, int threads)
        : o_(options), threads_(threads), world_(std::make_shared<RenderWorld>()) {}

    int answer() {
        read();
        clock_.begin("build");
        build_tracer(o_, frame_, *world_);
        build_integrator(o_, frame_, *world_);
        exposure_ = exposure_of(o_, world_->scene);
        clock_.begin("trace");
        if (frame_.spp == 1)
            trace_at_once();
        else
            trace_passes();
        clock_.end();
        if (pixels_done_ == 0) {
            progress_->stop();
            message("interrupted before the first tile: nothing is written");
            return interrupted_exit_code;
        }
        finish(*film_);
        return complete_ ? 0 : interrupted_exit_code;
    }

private:
    void read() {
        clock_.begin("read");
        Scene& scene = world_->scene = load_scene(o_);
        check_outputs(o_.outputs, {o_.stats_json}, scene.model_files);
        load_surroundings(scene);
        frame_ = frame_of(o_, scene);
        for (const std::string& path : o_.outputs) check_writable(path);
        if (!o_.stats_json.empty()) check_writable(o_.stats_json);
        say(o_, fmt::format("{}: {} solids, {} lights; picture {}x{}, {} threads", o_.scene, scene.solids.size(),
                            scene.lights.size(), frame_.size.width, frame_.size.height, threads_));
        if (!o_.quiet) warn_of_scene(scene, double(frame_.size.width) / frame_.size.height);
        if (nothing_is_left(scene)) throw WorkError(scene.file + ": no solid is left, and there is nothing to show");
    }

    void begin_progress(double work, double done) {
        progress_.emplace(
            work + pixels() * writing_work * double(o_.outputs.size()),
            o_.progress && !o_.quiet ? Progress::standard_error(*o_.progress) : Progress::standard_error(o_.quiet),
            done);
    }

    double pixels() const { return double(frame_.window.width) * frame_.window.height; }

    // One sample needs no sums, which take twice the film's memory.
    void trace_at_once() {
        const std::atomic<bool>& stop = catch_interrupts(!o_.quiet);
        begin_progress(pixels(), 0);
        BlockFunction block = [world = world_](const Window& part, Pixel* pixels, PixelLayers* layers,
                                               TraceCounters& counters) {
            world->integrator->block(part, pixels, layers, counters);
        };
        if (!o_.wire.empty())
            block = [paper = o_.alpha ? Pixel() : Pixel{.color = Vec3(1.0), .alpha = 1}](
                        const Window& part, Pixel* pixels, PixelLayers* layers, TraceCounters&) {
                std::fill_n(pixels, part.width * part.height, paper);
                if (layers) std::fill_n(layers, part.width * part.height, PixelLayers{});
            };
        Rendering rendering = render(
            Film(frame_.size.width, frame_.size.height, frame_.window, o_.layers), block, stop,
            [&](std::int64_t done) { progress_->advance(double(done)); }, grace);
        pixels_done_ = rendering.pixels_done;
        counters_ = rendering.counters;
        complete_ = rendering.film.complete;
        film_ = finished(std::move(rendering.film));
    }

    void trace_passes() {
        passes_.emplace(Passes::Settings{frame_.size.width, frame_.size.height, frame_.window, o_.layers,
                                         SampleRange{0, frame_.spp}, o_.noise.value_or(0)},
                        std::shared_ptr<const Integrator>(world_, &*world_->integrator));
        const std::atomic<bool>& stop = catch_interrupts(!o_.quiet);
        begin_progress(passes_->work(), passes_->work_done());
        Clock::time_point written = Clock::now();
        const auto is_due = [&] {
            return o_.write_every && Clock::now() - written >= std::chrono::duration<double>(*o_.write_every);
        };
        TilesEnd end = TilesEnd::all;
        while (end != TilesEnd::abandoned && !stop && !passes_->finished()) {
            end = passes_->go_on(
                stop, is_due, [&](std::int64_t done) { progress_->advance(double(done)); }, grace);
            if (!is_due() || stop || passes_->finished() || passes_->samples_of_all() == 0) continue;
            write(finished(passes_->film()), passes_->samples_of_all(), [](double) {});
            written = Clock::now();
        }
        complete_ = passes_->finished();
        samples_ = passes_->samples_of_all();
        pixels_done_ = passes_->pixels_begun();
        counters_ = passes_->counters();
        film_ = finished(passes_->film());
        passes_.reset();
    }

    // With all that is done to a film before it is written.
    Film finished(Film film) const {
        draw_strokes(film, world_->strokes, Vec3(0.0), line_width, o_.alpha);
        if (o_.denoise) denoise(film);
        return film;
    }

    void write(const Film& film, int samples, const std::function<void(double)>& work) {
        write_pictures(o_.outputs, film, format_of(o_, exposure_, threads_),
                       notes_of(o_, *world_, samples, clock_.wall("trace")), work);
    }

    void finish(const Film& film) {
        // Of a first pass that was not finished, pixels have one sample or none.
        const int samples = complete_ ? frame_.spp : std::max(samples_, 1);
        clock_.begin("write");
        try {
            write(film, samples, [&](double work) { progress_->advance(work); });
        } catch (...) {
            progress_->stop();
            throw;
        }
        clock_.end();
        if (complete_)
            progress_->finish();
        else
            progress_->stop();
        if (!o_.quiet && complete_ && std::any_of(o_.outputs.begin(), o_.outputs.end(), is_for_screen))
            if (const auto advice = exposure_advice(film, exposure_)) message("warning: " + *advice);
        const Scene& scene = world_->scene;
        write_statistics(o_, {scene.file, o_.via, world_->bsp ? name(o_.accel.value_or(Accel::bvh)) : "",
                              frame_.size.width, frame_.size.height, frame_.window, samples, threads_, o_.seed,
                              complete_, pixels_done_, clock_.times(), counters_, world_->bsp});
        for (const std::string& path : o_.outputs) say(o_, "wrote " + path);
        if (complete_) return;
        message(fmt::format(
            "interrupted after {}: the picture is marked incomplete",
            samples_ > 0 ? fmt::format("{} of {} samples of all pixels", samples_, frame_.spp)
                         : fmt::format("{:.0f} % of the pixels", std::floor(100 * double(pixels_done_) / pixels()))));
    }

    const RenderOptions& o_;
    const int threads_;
    const std::shared_ptr<RenderWorld> world_;
    PhaseClock clock_;
    Frame frame_;
    double exposure_ = 0;
    std::optional<Passes> passes_;
    std::optional<Progress> progress_;
    std::optional<Film> film_;
    bool complete_ = false;
    int samples_ = 0;  // that all pixels have, of a picture in passes
    std::int64_t pixels_done_ = 0;
    TraceCounters counters_;
};

int run_render(const RenderOptions& given) {
    RenderOptions o = given;
    check_render_options(o);
    if (o.denoise) {
        if (!o.wire.empty()) throw UsageError("--denoise: expected a picture with surfaces, got --wire");
        for (const ImageLayer layer : {ImageLayer::normal, ImageLayer::albedo})
            if (std::count(o.layers.begin(), o.layers.end(), layer) == 0) o.layers.push_back(layer);
    }
    check_source_date_epoch();  // or what is wrong with it is said when the work is done
    const int threads = o.threads.value_or(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    return RenderRun(o, threads).answer();
}

}  // namespace

Command add_render_command(CLI::App& program) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = add_render_options(program, options);
    return {command, [options] { return run_render(*options); }};
}

}  // namespace deburr
