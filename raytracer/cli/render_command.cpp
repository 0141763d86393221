// `deburr render SCENE -o FILE …`: renders a picture, exactly from the implicit surfaces unless told otherwise.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/render_pictures.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/cli/sums_file.hpp"
#include "raytracer/image/denoise.hpp"
#include "raytracer/image/display_server.hpp"
#include "raytracer/image/exposure.hpp"
#include "raytracer/image/oidn.hpp"
#include "raytracer/image/scene_pictures.hpp"
#include "raytracer/render/passes.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/scene/view_warnings.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/interrupt.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

using Clock = std::chrono::steady_clock;

// Width of wires in pixels: fine, but still black.
constexpr double line_width = 1;
// Time for tiles in hand to finish after a stop was requested.
constexpr std::chrono::milliseconds grace(300);
// Least time between pictures sent to a viewer, since that delays tiles.
constexpr double seconds_of_display = 0.5;
// EX_TEMPFAIL of sysexits.h: schedulers run the job again, and it continues from its checkpoint.
constexpr int to_be_resumed_exit_code = 75;

bool is_for_screen(const std::string& path) { return image_kind(path) == ImageKind::display; }

void write_statistics(const RenderOptions& o, const RunStatistics& run) {
    if (o.stats) fmt::print("{}", statistics_table(run));
    if (!o.stats_json.empty()) write_whole_file(o.stats_json, statistics_json(run));
}

// Tells when something is due that is done every so many seconds, or never.
class Timer {
public:
    explicit Timer(std::optional<double> seconds) : seconds_(seconds) {}
    bool is_due() const { return seconds_ && Clock::now() - begin_ >= std::chrono::duration<double>(*seconds_); }
    void restart() { begin_ = Clock::now(); }

private:
    std::optional<double> seconds_;
    Clock::time_point begin_ = Clock::now();
};

// The rendering of one picture.
class RenderRun {
public:
    RenderRun(const RenderOptions& options, int threads)
        : o_(options), threads_(threads), world_(std::make_shared<RenderWorld>()) {}

    int answer() {
        read();
        exposure_ = exposure_of(o_, world_->scene);
        const std::optional<SumsFile> earlier = checkpoint_to_resume();
        if (!earlier || !earlier->head.at("finished").get<bool>()) {
            clock_.begin("build");
            build_tracer(o_, frame_, *world_);
            if (earlier) frame_.spp = earlier->head.at("spp");
            build_integrator(o_, frame_, *world_);
        }
        clock_.begin("trace");
        if (frame_.spp == 1 && o_.checkpoint.empty())
            trace_at_once();
        else
            trace_passes(earlier);
        clock_.end();
        if (pixels_done_ == 0) {
            progress_->stop();
            message("interrupted before the first tile: nothing is written");
        } else {
            finish(*film_);
        }
        return complete_ ? 0 : kept_ && is_terminated() ? to_be_resumed_exit_code : interrupted_exit_code;
    }

private:
    // A hash of everything that pixels depend on, except window and samples.
    std::string scene_hash() const {
        ContentHash hash;
        const Scene& scene = world_->scene;
        hash.add_file(scene.file);
        std::vector<std::string> files = scene.model_files;
        for (const Background* b : {&scene.background, scene.environment ? &*scene.environment : nullptr})
            if (b && !b->file.empty()) files.push_back(b->file);
        for (const std::string& path : files) hash.add_file(path);
        for (const auto& [name, value] : scene.parameters) hash.add(name + "=" + value);
        const ModelSettings& m = o_.model;
        hash.add(fmt::format("{} {} {} {}", m.round, m.z_up ? int(*m.z_up) : 2, m.material, m.ground));
        const auto add_vector = [&](const std::optional<Vec3>& v) {
            hash.add(v ? fmt::format("{} {} {}", v->x, v->y, v->z) : "");
        };
        hash.add(m.keep.text());
        add_vector(m.color);
        add_vector(o_.from);
        hash.add(fmt::format("{} {} {} {} {}", frame_.size.width, frame_.size.height, o_.frame, o_.seed, o_.alpha));
        hash.add(fmt::format("{} {} {} {} {}", int(o_.integrator), o_.noise.value_or(0), int(o_.criterion), o_.draft,
                             o_.spp.value_or(scene.spp.value_or(0))));
        hash.add(o_.via);
        hash.add(o_.tolerance);
        hash.add(o_.flat ? "flat" : "");
        for (const ImageLayer layer : o_.layers) hash.add(layer_name(layer));
        return hash.text();
    }

    std::optional<SumsFile> checkpoint_to_resume() {
        if (o_.checkpoint.empty()) return std::nullopt;
        hash_ = scene_hash();
        std::error_code error;
        if (!o_.resume || !std::filesystem::exists(o_.checkpoint, error)) return std::nullopt;
        SumsFile file = read_sums(o_.checkpoint);
        const auto fail = [&](const std::string& what) { throw UsageError(o_.checkpoint + ": " + what); };
        if (file.head.at("scene") != hash_)
            fail("expected a checkpoint of this scene and these options, got one of others");
        if (window_of(file.head.at("window")) != frame_.window || window_of(file.head.at("whole")) != frame_.whole)
            fail("expected a checkpoint of this part of the picture, got one of another");
        frame_.spp = file.head.at("spp");
        const SampleRange range{file.head.at("samples").at(0), file.head.at("samples").at(1)};
        if (range != samples())
            fail(fmt::format("expected a checkpoint of the samples {}-{}, got one of {}-{}", samples().first,
                             samples().end, range.first, range.end));
        return file;
    }

    SampleRange samples() const { return o_.samples.value_or(SampleRange{0, frame_.spp}); }

    // Writes a checkpoint. An error is only reported, since the picture may still be written elsewhere.
    void keep() {
        if (o_.checkpoint.empty()) return;
        SumsFile file;
        file.head["version"] = DEBURR_VERSION;
        file.head["scene"] = hash_;
        file.head["size"] = {frame_.size.width, frame_.size.height};
        file.head["whole"] = window_head(frame_.whole);
        file.head["window"] = window_head(frame_.window);
        file.head["samples"] = {samples().first, samples().end};
        file.head["spp"] = frame_.spp;
        file.head["noise"] = o_.noise.value_or(0);
        file.head["finished"] = passes_->finished();
        file.head["layers"] = nlohmann::ordered_json::array();
        for (const ImageLayer layer : o_.layers) file.head["layers"].push_back(layer_name(layer));
        file.head["notes"] = notes_head(notes_of(o_, *world_, frame_.spp, 0), format_of(o_, exposure_, 1), o_.denoiser);
        file.bytes = passes_->bytes();
        try {
            write_sums(o_.checkpoint, file);
            kept_ = true;
        } catch (const WorkError& error) {
            kept_ = false;
            if (passes_->finished() && o_.outputs.empty()) throw;
            progress_->stop();
            message(std::string("warning: ") + error.what() + "; going on without");
        }
    }

    void read() {
        clock_.begin("read");
        Scene& scene = world_->scene = load_scene(o_);
        check_outputs(o_.outputs, {o_.stats_json, o_.checkpoint}, scene.model_files);
        load_pictures(scene);
        frame_ = frame_of(o_, scene);
        for (const std::string& path : o_.outputs) check_writable(path);
        for (const std::string& path : {o_.stats_json, o_.checkpoint})
            if (!path.empty()) check_writable(path);
        say(o_, fmt::format("{}: {} solids, {} lights; picture {}x{}, {} threads", o_.scene, scene.solids.size(),
                            scene.lights.size(), frame_.size.width, frame_.size.height, threads_));
        if (!o_.quiet) warn_of_scene(scene, double(frame_.size.width) / frame_.size.height);
        if (nothing_is_left(scene)) throw WorkError(scene.file + ": no solid is left, and there is nothing to show");
        if (!o_.display_server.empty()) viewer_ = std::make_unique<DisplayServer>(o_.display_server);
    }

    void begin_progress(double work, double done) {
        progress_.emplace(
            work + pixels() * writing_work * double(o_.outputs.size()),
            o_.progress && !o_.quiet ? Progress::standard_error(*o_.progress) : Progress::standard_error(o_.quiet),
            done);
    }

    double pixels() const { return double(frame_.window.width) * frame_.window.height; }

    // Renders a single sample per pixel without sums, which would take twice the film's memory.
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

    void trace_passes(const std::optional<SumsFile>& earlier) {
        passes_.emplace(Passes::Settings{frame_.size.width, frame_.size.height, frame_.window, o_.layers, samples(),
                                         o_.noise.value_or(0)},
                        world_->integrator ? std::shared_ptr<const Integrator>(world_, &*world_->integrator) : nullptr);
        if (earlier && !passes_->restore(earlier->bytes))
            throw WorkError(o_.checkpoint + ": expected the sums of this picture, got others");
        kept_ = earlier.has_value();
        const std::atomic<bool>& stop = catch_interrupts(!o_.quiet);
        begin_progress(passes_->work(), passes_->work_done());
        Timer write_timer(o_.write_every),
            keep_timer(o_.checkpoint.empty() ? std::nullopt : std::optional(o_.checkpoint_every)),
            show_timer(viewer_ ? std::optional(seconds_of_display) : std::nullopt);
        bool asked = false;
        const auto is_due = [&] {
            asked = asked || take_save_request();
            return asked || write_timer.is_due() || keep_timer.is_due() || (viewer_ && show_timer.is_due());
        };
        bool changed = false;
        while (!stop && !passes_->finished()) {
            const TilesEnd end = passes_->go_on(
                stop, is_due, [&](std::int64_t done) { progress_->advance(double(done)); }, grace);
            changed = true;
            if (end == TilesEnd::abandoned || stop || passes_->finished()) break;
            if (asked || keep_timer.is_due()) {
                keep();
                asked = changed = false;
                keep_timer.restart();
            }
            if (write_timer.is_due() && passes_->samples_of_all() > 0 && !o_.outputs.empty()) {
                write(finished(passes_->film()), passes_->samples_of_all(), [](double) {});
                write_timer.restart();
            }
            if (show_timer.is_due()) {
                show(finished(passes_->film()));
                show_timer.restart();
            }
        }
        if (changed) keep();
        complete_ = passes_->finished();
        samples_ = passes_->samples_of_all();
        pixels_done_ = passes_->pixels_begun();
        counters_ = passes_->counters();
        film_ = finished(passes_->film());
        passes_.reset();
    }

    // The film with everything that is done before it is written: wires and denoising.
    Film finished(Film film) const {
        draw_strokes(film, world_->strokes, Vec3(0.0), line_width, o_.alpha);
        denoise(film, o_.denoiser, threads_);
        return film;
    }

    // Shows the film in the viewer, if there is one; if the viewer was closed, rendering continues.
    void show(const Film& film) {
        if (!viewer_) return;
        try {
            viewer_->show(o_.outputs.empty() ? world_->scene.file : o_.outputs.front(), film);
        } catch (const WorkError& error) {
            viewer_.reset();
            progress_->stop();
            message(std::string("warning: ") + error.what() + "; going on without");
        }
    }

    void write(const Film& film, int samples, const std::function<void(double)>& work) {
        write_pictures(o_.outputs, film, format_of(o_, exposure_, threads_),
                       notes_of(o_, *world_, samples, clock_.wall("trace")), work);
    }

    void finish(const Film& film) {
        // If the first pass was not finished, pixels have one sample or none.
        const int taken = complete_ ? samples().end - samples().first : std::max(samples_, 1);
        clock_.begin("write");
        show(film);
        try {
            write(film, taken, [&](double work) { progress_->advance(work); });
        } catch (...) {
            progress_->stop();
            throw;
        }
        clock_.end();
        if (complete_)
            progress_->finish();
        else
            progress_->stop();
        // For a scene without light there was a warning already.
        if (!o_.quiet && complete_ && !is_unlit(world_->scene) &&
            std::any_of(o_.outputs.begin(), o_.outputs.end(), is_for_screen))
            if (const auto advice = exposure_advice(film, exposure_)) message("warning: " + *advice);
        const Scene& scene = world_->scene;
        write_statistics(o_, {scene.file, o_.via, world_->bsp ? name(o_.accel.value_or(Accel::bvh)) : "",
                              frame_.size.width, frame_.size.height, frame_.window, taken, threads_, o_.seed, complete_,
                              pixels_done_, clock_.times(), counters_, world_->bsp});
        for (const std::string& path : o_.outputs) say(o_, "wrote " + path);
        if (complete_) return;
        if (kept_ && o_.outputs.empty()) {
            message(fmt::format("interrupted after {} of {} samples of all pixels: --resume goes on from there",
                                samples_, samples().end - samples().first));
            return;
        }
        message(fmt::format(
            "interrupted after {}: the picture is marked incomplete",
            samples_ > 0 ? fmt::format("{} of {} samples of all pixels", samples_, samples().end - samples().first)
                         : fmt::format("{:.0f} % of the pixels", std::floor(100 * double(pixels_done_) / pixels()))));
    }

    const RenderOptions& o_;
    const int threads_;
    const std::shared_ptr<RenderWorld> world_;
    PhaseClock clock_;
    Frame frame_;
    double exposure_ = 0;
    std::optional<Passes> passes_;
    std::unique_ptr<DisplayServer> viewer_;  // may be null
    std::optional<Progress> progress_;
    std::optional<Film> film_;
    bool complete_ = false;
    bool kept_ = false;  // whether the checkpoint contains all samples
    std::string hash_;   // scene_hash(), if there are checkpoints
    int samples_ = 0;    // that all pixels have, when rendering in passes
    std::int64_t pixels_done_ = 0;
    TraceCounters counters_;
};

// Renders frames one after the other, each as a separate picture with its own checkpoint and exit code.
int render_frames(const RenderOptions& o, int threads) {
    Options asking = o;
    asking.quiet = true;
    const auto& parameters = load_scene(asking).parameters;
    const bool has_frame = parameters.count("frame") > 0, has_time = parameters.count("t") > 0;
    if (!has_frame && !has_time)
        throw UsageError(o.scene +
                         ": expected a scene with param(\"frame\", 1) or param(\"t\", 0) for --frames, got neither");
    for (int frame = o.frames->first; frame <= o.frames->last; ++frame) {
        RenderOptions one = o;
        if (has_frame) one.defines["frame"] = fmt::format("{}", frame);
        if (has_time) one.defines["t"] = fmt::format("{}", o.frames->time(frame));
        for (std::string& path : one.outputs) path = numbered("--frames", path, frame);
        for (std::string* path : {&one.checkpoint, &one.stats_json})
            if (!path->empty()) *path = numbered("--frames", *path, frame);
        if (const int code = RenderRun(one, threads).answer()) return code;
    }
    return 0;
}

int run_render(const RenderOptions& given) {
    RenderOptions o = given;
    check_render_options(o);
    if (o.denoiser == Denoiser::oidn) load_oidn();
    if (o.denoiser != Denoiser::none) {
        if (!o.wire.empty()) throw UsageError("--denoise: expected a picture with surfaces, got --wire");
        for (const ImageLayer layer : {ImageLayer::guide_normal, ImageLayer::albedo})
            if (std::count(o.layers.begin(), o.layers.end(), layer) == 0) o.layers.push_back(layer);
    }
    check_source_date_epoch();  // otherwise its error would be reported after the work
    const int threads = o.threads.value_or(default_threads());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    if (!o.checkpoint.empty()) {
        catch_save_requests();
        set_exit_code_of_terminated(to_be_resumed_exit_code);
    }
    return o.frames ? render_frames(o, threads) : RenderRun(o, threads).answer();
}

}  // namespace

Command add_render_command(CLI::App& program) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = add_render_options(program, options);
    return {command, [options] { return run_render(*options); }};
}

}  // namespace deburr
