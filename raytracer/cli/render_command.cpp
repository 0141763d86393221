// deburr render SCENE -o FILE …: a picture, exact from the implicit surfaces.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/cli/statistics.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/mesh/wire_frame.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/scene/illegal_densities.hpp"
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
    std::optional<Accel> accel;
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

void check_road(const std::string& via) {
    try {
        if (via != "implicit") parse_mesh_method("--via", via);
    } catch (const UsageError&) {
        throw UsageError(fmt::format("--via: expected implicit, {}, got '{}'", mesh_method_names(), via));
    }
}

void check_options(const RenderOptions& o) {
    check_road(o.via);
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
    if (o.scene.empty()) throw UsageError("render: expected a scene file");
    if (o.outputs.empty()) throw UsageError("render: expected an output file, -o FILE");
    check_image_names("-o", o.outputs);
    bool exr = false;
    for (const std::string& path : o.outputs) exr |= image_kind(path) == ImageKind::exr;
    if (!exr && !o.layers.empty()) throw UsageError("--aov: expected an output that ends in .exr, got none");
    if (!exr && o.float_color) throw UsageError("--float: expected an output that ends in .exr, got none");
    std::vector<std::string> files = o.outputs;
    if (!o.stats_json.empty()) files.push_back(o.stats_json);
    check_distinct(files);
}

// Better now than killed by the system in the middle of the work.
void check_memory(const Window& window, const std::vector<ImageLayer>& layers) {
    const double needed = double(window.width) * window.height * Film::bytes_per_pixel(layers);
    const double there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (needed > there)
        throw WorkError(fmt::format("a picture of {}x{} needs {:.1f} GiB of memory, this machine has {:.1f}",
                                    window.width, window.height, needed / 0x1p30, there / 0x1p30));
}

// Every file that can be written is, for the picture was dear; the first error is reported then.
void write_images(const RenderOptions& o, const Film& film, const ImageNotes& notes, int threads, Progress& progress) {
    std::string error;
    for (const std::string& path : o.outputs) {
        const double work = writing_work * double(film.pixels.size());
        double told = 0;
        try {
            write_image(path, film, {o.float_color, threads}, notes, [&](double share) {
                progress.advance(work * (share - told));
                told = share;
            });
        } catch (const std::exception& e) {
            if (error.empty()) error = e.what();
        }
    }
    if (error.empty()) return;
    progress.stop();
    throw WorkError(error);
}

int run_render(const RenderOptions& o) {
    check_options(o);
    const auto epoch = source_date_epoch();
    const std::atomic<bool>& stop = catch_interrupts(!o.quiet);
    const int threads = o.threads.value_or(tbb::info::default_concurrency());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    const auto say = [&](const std::string& line) {
        if (o.verbose && !o.quiet) message(line);
    };

    PhaseClock clock;
    clock.begin("read");
    const Scene scene = load_scene(o);
    const Size size = picture_size(o, scene);
    const Window window = o.crop.value_or(Window{0, 0, size.width, size.height});
    check_crop("--crop", window, size);
    check_memory(window, o.layers);
    for (const std::string& path : o.outputs) check_writable(path);
    if (!o.stats_json.empty()) check_writable(o.stats_json);
    const int spp = o.spp.value_or(scene.spp);
    say(fmt::format("{}: {} solids, {} lights; picture {}x{}, {} samples per pixel, {} threads", o.scene,
                    scene.solids.size(), scene.lights.size(), size.width, size.height, spp, threads));

    if (!o.quiet)
        for (const std::string& what : illegal_densities(scene, boxes_to_warn)) message("warning: " + what);

    clock.begin("build");
    std::unique_ptr<RayTracer> tracer;
    std::optional<BspStatistics> bsp;
    const Accel accel = o.accel.value_or(Accel::bsp);
    Mesh lines;  // whose edges are drawn
    if (o.via == "implicit") {
        auto implicit = std::make_unique<ImplicitTracer>(
            scene.solids, o.criterion, o.criterion == Criterion::lobb ? Search::always : Search::where_needed, accel);
        bsp = implicit->statistics();
        tracer = std::move(implicit);
        say(fmt::format("{} cells of {} half-spaces", bsp->cells, bsp->half_spaces));
    } else {
        SceneMesh mesh = mesh_scene(scene, picture_mesh_settings(o.via, o.tolerance), {&stop});
        say(fmt::format("{} triangles, {} vertices", mesh.mesh.triangles.size(), mesh.mesh.positions.size()));
        if (o.edges || !o.wire.empty()) lines = mesh.mesh;
        tracer =
            std::make_unique<MeshTracer>(o.flat ? flat_shaded(std::move(mesh.mesh)) : std::move(mesh.mesh), mesh.near);
    }
    clock.end();

    clock.begin("trace");
    const Integrator integrator(
        scene, *tracer,
        {size.width, size.height, spp, o.seed, std::count(o.layers.begin(), o.layers.end(), ImageLayer::cost) > 0});
    Pixel paper;  // of a wire frame
    paper.color = Vec3(1.0);
    paper.alpha = 1;
    const double pixels = double(window.width) * window.height;
    Progress progress(pixels * (spp + writing_work * double(o.outputs.size())), Progress::standard_error(o.quiet));
    Rendering rendering = render(
        Film(size.width, size.height, window, o.layers),
        [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
            if (o.wire.empty()) return integrator.block(block, pixels, layers, counters);
            std::fill_n(pixels, block.width * block.height, paper);
            if (layers) std::fill_n(layers, block.width * block.height, PixelLayers{});
        },
        stop, [&](std::int64_t done) { progress.advance(double(done) * spp); });
    if (!lines.triangles.empty())
        draw_strokes(
            rendering.film,
            wire_frame(lines, mesh_edges(lines, o.via == "triage" ? EdgeChoice::polygons : EdgeChoice::triangles),
                       *tracer, PinholeCamera(scene.camera, size.width, size.height), size.width, size.height,
                       o.wire == "front" ? WireMode::front : WireMode::visible),
            Vec3(0.0), line_width);
    const Film& film = rendering.film;
    if (rendering.pixels_done == 0) {
        progress.stop();
        message("interrupted before the first tile: nothing is written");
        return interrupted_exit_code;
    }

    clock.begin("write");
    ImageNotes notes;
    notes.camera = scene.camera;
    notes.spp = spp;
    notes.date = date_text(epoch.value_or(std::time(nullptr)));
    if (!epoch) notes.render_seconds = clock.wall("trace");
    notes.attributes = {{"scene", scene.file},
                        {"seed", fmt::format("{}", o.seed)},
                        {"via", o.via},
                        {"criterion", o.criterion == Criterion::lobb ? "lobb" : "exact"}};
    if (bsp) notes.attributes.push_back({"accel", name(accel)});
    for (const auto& [name, value] : scene.parameters) notes.attributes.push_back({"parameter." + name, value});
    write_images(o, film, notes, threads, progress);
    clock.end();
    if (film.complete)
        progress.finish();
    else
        progress.stop();

    if (o.stats || !o.stats_json.empty()) {
        const RunStatistics run{
            scene.file, o.via,         bsp ? name(accel) : "", size.width,    size.height,        window, spp, threads,
            o.seed,     film.complete, rendering.pixels_done,  clock.times(), rendering.counters, bsp};
        if (o.stats) fmt::print("{}", statistics_table(run));
        if (!o.stats_json.empty()) write_whole_file(o.stats_json, statistics_json(run));
    }
    for (const std::string& path : o.outputs) say("wrote " + path);
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
    add_picture_options(*command, *options);
    command
        ->add_option("--via", options->via,
                     "how surfaces are found: implicit (exact, the default), or as a mesh by " + mesh_method_names())
        ->type_name("NAME");
    command
        ->add_option_function<std::string>(
            "--accel", [options](const std::string& text) { options->accel = parse_accel("--accel", text); },
            "implicit only: find surfaces by our own BVH over BSP cells or by Embree's, with the same picture; "
            "default: "
            "bsp")
        ->type_name("bsp|embree");
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
    add_run_options(*command, *options);
    add_statistics_options(*command, *options);
    return {command, [options] { return run_render(*options); }};
}

}  // namespace deburr
