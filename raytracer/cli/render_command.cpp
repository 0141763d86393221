// deburr render SCENE -o FILE …: a picture, exact from the implicit surfaces.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/image/denoise.hpp"
#include "raytracer/image/exposure.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/image/surroundings_file.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/render/sample_count.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/scene/view_warnings.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/interrupt.hpp"
#include "raytracer/util/message.hpp"
#include "raytracer/util/progress.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

struct RenderOptions : Options {
    std::string via = "implicit", tolerance;
    std::string wire;  // "": no wire frame
    bool flat = false, edges = false;
    int bits = 8;  // of a PNG
    bool alpha = false;
    bool draft = false;
    std::optional<Accel> accel;
    IntegratorKind integrator = IntegratorKind::automatic;
    std::optional<double> exposure;  // of pictures for the screen
    std::optional<double> noise, seconds;
    ViewTransform view = ViewTransform::standard;
    bool denoise = false;
};

// Boxes to look at for each sum and difference before rendering; `info` looks longer.
constexpr int boxes_to_warn = 1000;
// Of a mesh's edges, in pixels: fine, and still black.
constexpr double line_width = 1;
// Work to write a pixel into a file, where tracing one sample of it is 1: a guess, for the bar.
constexpr double writing_work = 0.1;

// https://reproducible-builds.org/specs/source-date-epoch/
std::optional<std::time_t> source_date_epoch() {
    const char* text = std::getenv("SOURCE_DATE_EPOCH");
    if (!text || !*text) return std::nullopt;
    constexpr std::int64_t last = 253402300799;  // the end of the year 9999
    return std::time_t(parse_whole("SOURCE_DATE_EPOCH", text, 0, last));
}

std::string date_text(std::time_t time) {
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[sizeof "YYYY:MM:DD hh:mm:ss"];
    std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &utc);
    return text;
}

void check_via(const std::string& via) {
    try {
        if (via != "implicit") parse_mesh_method("--via", via);
    } catch (const UsageError&) {
        throw UsageError(fmt::format("--via: expected implicit, {}, got '{}'", mesh_method_names(), via));
    }
}

void check_options(const RenderOptions& o) {
    check_via(o.via);
    if (!o.tolerance.empty()) {
        if (o.via != "triage" && o.via != "octree")
            throw UsageError("--tolerance: expected --via triage or octree, got '" + o.via + "'");
        parse_tolerance(o.tolerance);
    }
    if (o.accel && o.via != "implicit") throw UsageError("--accel: expected --via implicit, got '" + o.via + "'");
    for (const auto& [name, given] : {std::pair{"--flat", o.flat}, {"--edges", o.edges}, {"--wire", !o.wire.empty()}})
        if (given && o.via == "implicit")
            throw UsageError(fmt::format("{}: expected --via {}, got 'implicit'", name, mesh_method_names()));
    if (!o.wire.empty() && o.wire != "visible" && o.wire != "front")
        throw UsageError("--wire: expected visible or front, got '" + o.wire + "'");
    if (o.draft && o.spp) throw UsageError("--draft: expected it without --spp, for it is --spp 1");
    if (o.scene.empty()) throw UsageError("render: expected a scene file");
    if (o.outputs.empty()) throw UsageError("render: expected an output file, -o FILE");
    check_image_names("-o", o.outputs);
    bool exr = false, png = false;
    for (const std::string& path : o.outputs) {
        exr |= image_kind(path) == ImageKind::exr;
        png |= image_extension(path) == ".png";
        if (o.alpha && image_extension(path) != ".png" && image_kind(path) != ImageKind::exr)
            throw UsageError("--alpha: expected outputs that end in .exr or .png, got '" + path + "'");
    }
    if (o.integrator == IntegratorKind::preview)
        for (const auto& [name, given] : {std::pair{"--noise", o.noise.has_value()}, {"--time", o.seconds.has_value()}})
            if (given) throw UsageError(fmt::format("{}: expected --integrator path, got 'preview'", name));
    if (o.draft && (o.noise || o.seconds))
        throw UsageError(
            fmt::format("{}: expected it without --draft, which is one sample", o.noise ? "--noise" : "--time"));
    if (o.seconds && o.spp) throw UsageError("--time: expected no --spp beside it, got one");
    if (!png && o.bits != 8) throw UsageError("--bits: expected an output that ends in .png, got none");
    if (!exr && !o.layers.empty()) throw UsageError("--aov: expected an output that ends in .exr, got none");
    if (!exr && o.float_color) throw UsageError("--float: expected an output that ends in .exr, got none");
    check_outputs(o.outputs, {o.stats_json}, {o.scene});
}

// Every file that can be written is, for the picture was dear; the first error is reported then.
void write_images(const RenderOptions& o, const Film& film, const ImageNotes& notes, double exposure, int threads,
                  Progress& progress) {
    std::string error;
    for (const std::string& path : o.outputs) {
        const double work = writing_work * double(film.pixels.size());
        double reported = 0;
        try {
            write_image(path, film, {o.float_color, threads, o.bits, o.alpha, exposure, o.view}, notes,
                        [&](double share) {
                            progress.advance(work * (share - reported));
                            reported = share;
                        });
        } catch (const std::exception& e) {
            if (error.empty()) error = e.what();
        }
    }
    if (error.empty()) return;
    progress.stop();
    throw WorkError(error);
}

// What rays are traced in, and how. Tiles that are abandoned share in it.
struct World {
    Scene scene;
    std::unique_ptr<RayTracer> tracer;
    std::optional<Integrator> integrator;
    std::optional<BspStatistics> bsp;
    std::vector<Stroke> strokes;  // that are drawn over the picture
};

bool is_for_screen(const std::string& path) { return image_kind(path) == ImageKind::display; }

void say(const RenderOptions& o, const std::string& line) {
    if (o.verbose && !o.quiet) message(line);
}

// A wire frame is black on white.
double exposure_of(const RenderOptions& o, const Scene& scene) {
    return o.wire.empty() ? o.exposure.value_or(scene.exposure) : 0;
}

// The picture's size and the part of it that is rendered.
struct Frame {
    Size size;
    Window window;
    int spp = 0;  // 0: to be found
};

Frame frame_of(const RenderOptions& o, const Scene& scene) {
    Frame frame;
    frame.size = picture_size(o, scene);
    frame.window = picture_window(o, scene, Film::bytes_per_pixel(o.layers));
    frame.spp = o.draft || !o.wire.empty() ? 1 : o.spp.value_or(scene.spp.value_or(0));
    return frame;
}

void build_implicit(const RenderOptions& o, World& world) {
    auto tracer = std::make_unique<ImplicitTracer>(
        world.scene.solids, o.criterion, o.criterion == Criterion::lobb ? RootMethod::always : RootMethod::where_needed,
        o.accel.value_or(Accel::bvh));
    world.bsp = tracer->statistics();
    world.tracer = std::move(tracer);
    say(o, fmt::format("{} cells of {} half-spaces", world.bsp->cells, world.bsp->half_spaces));
}

void build_mesh(const RenderOptions& o, const Frame& frame, World& world) {
    SceneMesh mesh = mesh_scene(world.scene, picture_mesh_settings(o.via, o.tolerance));
    say(o, fmt::format("{} triangles, {} vertices", mesh.mesh.triangles.size(), mesh.mesh.positions.size()));
    const bool lines = o.edges || !o.wire.empty();
    Mesh drawn = lines ? mesh.mesh : Mesh();
    world.tracer =
        std::make_unique<MeshTracer>(o.flat ? flat_shaded(std::move(mesh.mesh)) : std::move(mesh.mesh), mesh.near);
    if (!lines) return;
    const auto edges = mesh_edges(drawn, o.via == "triage" ? EdgeChoice::polygons : EdgeChoice::triangles);
    const PinholeCamera camera(world.scene.camera, frame.size.width, frame.size.height);
    world.strokes = wire_frame(drawn, edges, *world.tracer, camera, frame.window,
                               o.wire == "front" ? WireMode::front : WireMode::visible);
}

// Samples per pixel that take about so long, by one sample of some of the tiles. What a picture of so many samples
// looks like does not depend on the time.
int samples_in(double seconds, const Scene& scene, const RayTracer& tracer, const Frame& frame,
               RenderSettings settings) {
    // A share of the picture, and of the time left that a fair guess uses.
    constexpr std::int64_t tiles_tried = 64;
    constexpr double used = 0.95;
    const auto start = std::chrono::steady_clock::now();
    const auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    settings.spp = 1;
    settings.noise = 0;
    settings.integrator = IntegratorKind::path;
    const Integrator integrator(scene, tracer, settings);
    const double prepared = passed();
    const std::int64_t tiles = tile_count(frame.window), stride = std::max<std::int64_t>(1, tiles / tiles_tried);
    const std::int64_t tried = (tiles + stride - 1) / stride;
    tbb::parallel_for(std::int64_t(0), tried, [&](std::int64_t i) {
        std::array<Pixel, tile_side * tile_side> pixels;
        TraceCounters counters;
        integrator.block(tile(frame.window, i * stride), pixels.data(), nullptr, counters);
    });
    const double one = std::max(1e-6, passed() - prepared) * double(tiles) / double(tried);
    return int(std::clamp(used * (seconds - passed()) / one, 2.0, double(max_samples)));
}

Rendering trace(const RenderOptions& o, const Frame& frame, const std::shared_ptr<const World>& world,
                const std::atomic<bool>& stop, Progress& progress) {
    // What tiles in hand are given once a stop is asked for.
    constexpr std::chrono::milliseconds grace(300);
    BlockFunction block = [world](const Window& part, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
        world->integrator->block(part, pixels, layers, counters);
    };
    if (!o.wire.empty())
        block = [paper = o.alpha ? Pixel() : Pixel{.color = Vec3(1.0), .alpha = 1}](
                    const Window& part, Pixel* pixels, PixelLayers* layers, TraceCounters&) {
            std::fill_n(pixels, part.width * part.height, paper);
            if (layers) std::fill_n(layers, part.width * part.height, PixelLayers{});
        };
    Rendering rendering = render(
        Film(frame.size.width, frame.size.height, frame.window, o.layers), block, stop,
        [&](std::int64_t done) { progress.advance(double(done) * frame.spp); }, grace);
    draw_strokes(rendering.film, world->strokes, Vec3(0.0), line_width, o.alpha);
    return rendering;
}

ImageNotes notes_of(const RenderOptions& o, const World& world, int spp, double trace_seconds) {
    const auto epoch = source_date_epoch();
    const Scene& scene = world.scene;
    ImageNotes notes;
    notes.camera = scene.camera;
    notes.spp = spp;
    for (std::size_t i = 0; i < scene.solids.size(); ++i)
        notes.solids.push_back(scene.names[i].empty() ? fmt::format("solid {}", i + 1) : scene.names[i]);
    notes.date = date_text(epoch.value_or(std::time(nullptr)));
    if (!epoch) notes.render_seconds = trace_seconds;
    notes.attributes = {{"scene", scene.file},
                        {"seed", fmt::format("{}", o.seed)},
                        {"via", o.via},
                        {"criterion", o.criterion == Criterion::lobb ? "lobb" : "exact"}};
    if (o.denoise) notes.attributes.push_back({"denoised", "a-trous"});
    if (const double exposure = exposure_of(o, scene))
        notes.attributes.push_back({"exposure", fmt::format("{}", exposure)});
    if (o.noise) notes.attributes.push_back({"noise", fmt::format("{}", *o.noise)});
    if (o.view != ViewTransform::standard) notes.attributes.push_back({"view", "agx"});
    if (world.bsp) notes.attributes.push_back({"accel", name(o.accel.value_or(Accel::bvh))});
    for (const auto& [name, value] : scene.parameters) notes.attributes.push_back({"parameter." + name, value});
    return notes;
}

void write_statistics(const RenderOptions& o, const RunStatistics& run) {
    if (o.stats) fmt::print("{}", statistics_table(run));
    if (!o.stats_json.empty()) write_whole_file(o.stats_json, statistics_json(run));
}

void warn(const Scene& scene, double aspect) {
    const VanishedParts vanished = vanished_parts(scene);
    for (const std::vector<std::string>& lines :
         {illegal_densities(scene, boxes_to_warn), vanished.rounded_away, vanished.empty, view_warnings(scene, aspect)})
        for (const std::string& line : lines) message("warning: " + line);
}

int run_render(const RenderOptions& given) {
    RenderOptions o = given;
    check_options(o);
    if (o.denoise) {
        if (!o.wire.empty()) throw UsageError("--denoise: expected a picture with surfaces, got --wire");
        for (const ImageLayer layer : {ImageLayer::normal, ImageLayer::albedo})
            if (std::count(o.layers.begin(), o.layers.end(), layer) == 0) o.layers.push_back(layer);
    }
    source_date_epoch();  // or what is wrong with it is said when the work is done
    const int threads = o.threads.value_or(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));

    PhaseClock clock;
    clock.begin("read");
    const auto world = std::make_shared<World>();
    const Scene& scene = world->scene = load_scene(o);
    check_outputs(o.outputs, {o.stats_json}, scene.model_files);
    load_surroundings(world->scene);
    Frame frame = frame_of(o, scene);
    const Size size = frame.size;
    const Window window = frame.window;
    // With a bound of noise a picture is finished by it, and the samples are only their limit.
    constexpr int most_samples = 4096;
    if (o.noise && !o.spp) frame.spp = most_samples;
    for (const std::string& path : o.outputs) check_writable(path);
    if (!o.stats_json.empty()) check_writable(o.stats_json);
    say(o, fmt::format("{}: {} solids, {} lights; picture {}x{}, {} threads", o.scene, scene.solids.size(),
                       scene.lights.size(), size.width, size.height, threads));
    if (!o.quiet) warn(scene, double(size.width) / size.height);
    if (nothing_is_left(scene)) throw WorkError(scene.file + ": no solid is left, and there is nothing to show");

    clock.begin("build");
    if (o.via == "implicit")
        build_implicit(o, *world);
    else
        build_mesh(o, frame, *world);
    const bool cost = std::count(o.layers.begin(), o.layers.end(), ImageLayer::cost) > 0;
    const double exposure = exposure_of(o, scene);
    RenderSettings settings{size.width, size.height, frame.spp, o.seed, cost, !o.alpha};
    settings.noise = o.noise.value_or(0);
    settings.integrator = o.noise || o.seconds ? IntegratorKind::path : o.integrator;
    if (o.seconds)
        frame.spp = settings.spp = samples_in(*o.seconds, scene, *world->tracer, frame, settings);
    else if (frame.spp == 0)
        frame.spp = settings.spp = sample_count(scene, *world->tracer, settings, exposure);
    const int spp = frame.spp;
    say(o, fmt::format("{} samples per pixel", spp));
    world->integrator.emplace(scene, *world->tracer, settings);

    clock.begin("trace");
    const std::atomic<bool>& stop = catch_interrupts(!o.quiet);
    const double pixels = double(window.width) * window.height;
    Progress progress(pixels * (spp + writing_work * double(o.outputs.size())), Progress::standard_error(o.quiet));
    Rendering rendering = trace(o, frame, world, stop, progress);
    if (o.denoise) denoise(rendering.film);
    const Film& film = rendering.film;
    clock.end();
    if (rendering.pixels_done == 0) {
        progress.stop();
        message("interrupted before the first tile: nothing is written");
        return interrupted_exit_code;
    }

    clock.begin("write");
    write_images(o, film, notes_of(o, *world, spp, clock.wall("trace")), exposure, threads, progress);
    clock.end();
    if (film.complete)
        progress.finish();
    else
        progress.stop();
    if (!o.quiet && film.complete && std::any_of(o.outputs.begin(), o.outputs.end(), is_for_screen))
        if (const auto advice = exposure_advice(film, exposure)) message("warning: " + *advice);
    write_statistics(
        o, {scene.file, o.via, world->bsp ? name(o.accel.value_or(Accel::bvh)) : "", size.width, size.height, window,
            spp, threads, o.seed, film.complete, rendering.pixels_done, clock.times(), rendering.counters, world->bsp});
    for (const std::string& path : o.outputs) say(o, "wrote " + path);
    if (film.complete) return 0;
    message(fmt::format("interrupted after {:.0f} % of the pixels: the picture is marked incomplete",
                        std::floor(100 * double(rendering.pixels_done) / pixels)));
    return interrupted_exit_code;
}

}  // namespace

Command add_render_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("render", "render a scene to image files");
    const auto options = std::make_shared<RenderOptions>();
    add_scene_options(*command, *options);
    add_output_option(*command, *options, known_extensions());
    add_picture_options(*command, *options, "the scene's, or as many as leave hardly any noise, 16 to 256");
    command->add_flag("--draft", options->draft, "one sample per pixel, whatever the scene says: quick, without noise");
    command
        ->add_option("--via", options->via,
                     "how surfaces are found: implicit (exact, the default), or as a mesh by " + mesh_method_names())
        ->type_name("NAME");
    command
        ->add_option_function<std::string>(
            "--accel", [options](const std::string& text) { options->accel = parse_accel("--accel", text); },
            "implicit only: find surfaces by our own BVH over BSP cells or by Embree's, with the same picture; "
            "default: bvh")
        ->type_name("bvh|embree");
    command
        ->add_option_function<std::string>(
            "--integrator",
            [options](const std::string& text) { options->integrator = parse_integrator("--integrator", text); },
            "path finds all light; preview has no noise, shadows and polished reflections; default: path from two "
            "samples per pixel on, preview with one")
        ->type_name("path|preview");
    command
        ->add_option_function<std::string>(
            "--noise", [options](const std::string& text) { options->noise = parse_positive("--noise", text); },
            "paths only: take samples until this much noise is left in each part of the picture, as a share of white "
            "on a display, 0.01: hardly seen; --spp is their limit, 4096 by default")
        ->type_name("X");
    command
        ->add_option_function<std::string>(
            "--time", [options](const std::string& text) { options->seconds = parse_positive("--time", text); },
            "paths only: as many samples as take about so many seconds")
        ->type_name("SECONDS");
    command
        ->add_option_function<std::string>(
            "--view",
            [options](const std::string& text) {
                if (text != "standard" && text != "agx")
                    throw UsageError("--view: expected standard or agx, got '" + text + "'");
                options->view = text == "agx" ? ViewTransform::agx : ViewTransform::standard;
            },
            "tone curve of files for the screen, not of an EXR: standard clips what is brighter than white, agx lets "
            "it "
            "go to white softly; default: standard")
        ->type_name("standard|agx");
    command->add_flag("--denoise", options->denoise,
                      "smooth the noise that is left, guided by normals and albedo, which an EXR then has, too: for a "
                      "quick look, not for measurements");
    command
        ->add_option("--tolerance", options->tolerance,
                     "meshes only: the mesh's tolerance, as for mesh; default: 0.03 of each solid's least radius")
        ->type_name("D");
    command->add_flag("--flat", options->flat, "meshes only: shade each facet with one normal");
    command->add_flag("--edges", options->edges, "meshes only: draw the polygons' edges as black lines");
    command
        ->add_option(
            "--wire", options->wire,
            "meshes only: draw edges alone, with hidden lines removed (visible), or all of faces towards the camera "
            "(front)")
        ->type_name("visible|front");
    command
        ->add_option_function<std::string>(
            "--bits",
            [options](const std::string& text) {
                if (text != "8" && text != "16") throw UsageError("--bits: expected 8 or 16, got '" + text + "'");
                options->bits = text == "8" ? 8 : 16;
            },
            "of each number in a PNG; default: 8")
        ->type_name("8|16");
    command
        ->add_option_function<std::string>(
            "--exposure",
            [options](const std::string& text) { options->exposure = parse_exposure("--exposure", text); },
            "of pictures for the screen, in stops: 1 shows the light twice as bright, -1 half as bright; .exr and .hdr "
            "keep the light as it is; default: the scene's")
        ->type_name("E");
    command->add_flag("--alpha", options->alpha,
                      "without the background that the camera sees: a PNG is transparent there, and an EXR black");
    add_run_options(*command, *options);
    add_statistics_options(*command, *options);
    return {command, [options] { return run_render(*options); }};
}

}  // namespace deburr
