#include "raytracer/cli/render_world.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/render/passes.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/render/sample_count.hpp"
#include "raytracer/scene/illegal_densities.hpp"
#include "raytracer/scene/seam_warnings.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/scene/view_warnings.hpp"
#include "raytracer/util/message.hpp"

namespace deburr {
namespace {

// Boxes examined for each sum and difference before rendering; `info` examines more.
constexpr int boxes_to_warn = 1000;

void build_implicit(const RenderOptions& o, RenderWorld& world) {
    auto tracer = std::make_unique<ImplicitTracer>(
        world.scene.solids, o.criterion, o.criterion == Criterion::lobb ? RootMethod::always : RootMethod::where_needed,
        o.accel.value_or(Accel::bvh));
    world.bsp = tracer->statistics();
    world.tracer = std::move(tracer);
    say(o, fmt::format("{} cells of {} half-spaces", world.bsp->cells, world.bsp->half_spaces));
}

void build_mesh(const RenderOptions& o, const Frame& frame, RenderWorld& world) {
    SceneMesh mesh = mesh_scene(world.scene, picture_mesh_settings(o.via, o.tolerance));
    say(o, fmt::format("{} triangles, {} vertices", mesh.mesh.triangles.size(), mesh.mesh.positions.size()));
    const bool lines = o.edges || !o.wire.empty();
    Mesh drawn = lines ? mesh.mesh : Mesh();
    world.tracer =
        std::make_unique<MeshTracer>(o.flat ? flat_shaded(std::move(mesh.mesh)) : std::move(mesh.mesh), mesh.near);
    if (!lines) return;
    const auto edges = mesh_edges(drawn, o.via == "triage" ? EdgeChoice::polygons : EdgeChoice::triangles);
    const ProjectiveCamera camera(world.scene.camera, frame.size.width, frame.size.height);
    world.strokes = wire_frame(drawn, edges, *world.tracer, camera, frame.window,
                               o.wire == "front" ? WireMode::front : WireMode::visible);
}

// The number of samples per pixel that takes about `seconds`, estimated from one sample of some tiles. The picture with
// a given number of samples does not depend on the time.
int samples_in(double seconds, const Scene& scene, const RayTracer& tracer, const Frame& frame,
               RenderSettings settings) {
    // Number of tiles tried, and the fraction of the remaining time that the estimate uses.
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

}  // namespace

void say(const RenderOptions& o, const std::string& line) {
    if (o.verbose && !o.quiet) message(line);
}

double exposure_of(const RenderOptions& o, const Scene& scene) {
    return o.wire.empty() ? o.exposure.value_or(scene.exposure) : 0;
}

Frame frame_of(const RenderOptions& o, const Scene& scene) {
    Frame frame;
    frame.size = picture_size(o, scene);
    frame.spp = o.draft || !o.wire.empty() ? 1 : o.spp.value_or(scene.spp.value_or(0));
    const bool sums = frame.spp != 1 || !o.checkpoint.empty();
    Passes::Settings settings;
    settings.layers = o.layers;
    settings.noise = o.noise.value_or(0);
    const double bytes = sums ? Passes::bytes_per_pixel(settings) : Film::bytes_per_pixel(o.layers);
    if (!o.tile) {
        frame.whole = frame.window = picture_window(o, scene, bytes);
        return frame;
    }
    // The whole picture need not fit into this machine's memory.
    frame.whole = o.crop.value_or(Window{0, 0, frame.size.width, frame.size.height});
    check_crop("--crop", frame.whole, frame.size);
    Options share = o;
    share.crop = share_of("--tile", *o.tile, frame.whole);
    frame.window = picture_window(share, scene, bytes);
    return frame;
}

void warn_of_scene(const Scene& scene, double aspect) {
    const VanishedParts vanished = vanished_parts(scene);
    for (const std::vector<std::string>& lines : {illegal_densities(scene, boxes_to_warn), vanished.rounded_away,
                                                  vanished.empty, seam_warnings(scene), view_warnings(scene, aspect)})
        for (const std::string& line : lines) message("warning: " + line);
}

void build_tracer(const RenderOptions& o, const Frame& frame, RenderWorld& world) {
    if (o.via == "implicit")
        build_implicit(o, world);
    else
        build_mesh(o, frame, world);
}

void build_integrator(const RenderOptions& o, Frame& frame, RenderWorld& world) {
    // With a noise bound the picture is finished by that, and the number of samples is only a limit.
    constexpr int most_samples = 4096;
    if (o.noise && !o.spp) frame.spp = most_samples;
    const bool cost = std::count(o.layers.begin(), o.layers.end(), ImageLayer::cost) > 0;
    RenderSettings settings{frame.size.width, frame.size.height, frame.spp, o.seed, cost, !o.alpha};
    settings.noise = o.noise.value_or(0);
    settings.integrator = o.noise || o.seconds ? IntegratorKind::path : o.integrator;
    if (o.seconds)
        settings.spp = samples_in(*o.seconds, world.scene, *world.tracer, frame, settings);
    else if (frame.spp == 0) {
        const SampleCount count = sample_count(world.scene, *world.tracer, settings, exposure_of(o, world.scene));
        settings.spp = count.samples;
        if (count.samples < count.wanted && !o.quiet)
            message(fmt::format("{} samples per pixel, not {}, which would take long; --spp {} takes them",
                                count.samples, count.wanted, count.wanted));
    }
    frame.spp = settings.spp;
    say(o, fmt::format("{} samples per pixel", frame.spp));
    world.integrator.emplace(world.scene, *world.tracer, settings);
}

}  // namespace deburr
