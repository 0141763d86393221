#include "raytracer/cli/render_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

void check_via(const std::string& via) {
    try {
        if (via != "implicit") parse_mesh_method("--via", via);
    } catch (const UsageError&) {
        throw UsageError(fmt::format("--via: expected implicit, {}, got '{}'", mesh_method_names(), via));
    }
}

void check_mesh_options(const RenderOptions& o) {
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
}

// Checks options that take samples until a goal is reached.
void check_sample_options(const RenderOptions& o) {
    if (o.draft && o.spp) throw UsageError("--draft: expected it without --spp, for it is --spp 1");
    if (o.integrator == IntegratorKind::preview)
        for (const auto& [name, given] : {std::pair{"--noise", o.noise.has_value()}, {"--time", o.seconds.has_value()}})
            if (given) throw UsageError(fmt::format("{}: expected --integrator path, got 'preview'", name));
    if (o.draft && (o.noise || o.seconds))
        throw UsageError(
            fmt::format("{}: expected it without --draft, which is one sample", o.noise ? "--noise" : "--time"));
    if (o.seconds && o.spp) throw UsageError("--time: expected no --spp beside it, got one");
}

// Checks options of checkpoints, which work in passes of samples.
void check_checkpoint_options(const RenderOptions& o) {
    if (o.checkpoint.empty()) {
        if (o.resume) throw UsageError("--resume: expected --checkpoint FILE, which it goes on from");
        if (o.samples) throw UsageError("--samples: expected --checkpoint FILE, which takes their sums for merge");
        return;
    }
    if (!o.wire.empty() || o.edges)
        throw UsageError(
            fmt::format("--checkpoint: expected no lines to be drawn, got {}", o.edges ? "--edges" : "--wire"));
    if (o.seconds) throw UsageError("--checkpoint: expected no --time, which is another number of samples every time");
    if (!o.samples) return;
    if (!o.spp) throw UsageError("--samples: expected --spp N beside it, of which they are a part");
    if (o.noise) throw UsageError("--samples: expected no --noise, which decides by all samples");
    if (*o.spp == 1) throw UsageError("--samples: expected an --spp of 2 and more, got 1");
    if (o.samples->end > *o.spp)
        throw UsageError(fmt::format("--samples: expected some of the {} of --spp, got {}-{}", *o.spp, o.samples->first,
                                     o.samples->end));
    if (std::count(o.layers.begin(), o.layers.end(), ImageLayer::cost) > 0)
        throw UsageError("--samples: expected no layer cost, which depends on how samples travel together");
}

}  // namespace

void check_render_options(const RenderOptions& o) {
    check_mesh_options(o);
    if (o.scene.empty()) throw UsageError("render: expected a scene file");
    if (o.outputs.empty() && o.checkpoint.empty() && o.display_server.empty())
        throw UsageError("render: expected an output file, -o FILE");
    check_image_names("-o", o.outputs);
    check_sample_options(o);
    check_checkpoint_options(o);
    bool exr = false, png = false;
    for (const std::string& path : o.outputs) {
        exr |= image_kind(path) == ImageKind::exr;
        png |= image_extension(path) == ".png";
        if (o.alpha && image_extension(path) != ".png" && image_kind(path) != ImageKind::exr)
            throw UsageError("--alpha: expected outputs that end in .exr or .png, got '" + path + "'");
    }
    if (!png && o.bits != 8 && o.checkpoint.empty())
        throw UsageError("--bits: expected an output that ends in .png, got none");
    if (!exr && !o.layers.empty() && o.checkpoint.empty())
        throw UsageError("--aov: expected an output that ends in .exr, got none");
    if (!exr && o.float_color && o.checkpoint.empty())
        throw UsageError("--float: expected an output that ends in .exr, got none");
    check_outputs(o.outputs, {o.stats_json, o.checkpoint}, {o.scene});
}

namespace {

using SharedOptions = std::shared_ptr<RenderOptions>;

// Adds an option whose text parse(name, text) converts for a member.
template <class Member, class Parse>
void add_parsed(CLI::App& command, const SharedOptions& options, const std::string& name, const std::string& type,
                Member RenderOptions::*member, Parse parse, const std::string& description) {
    command
        .add_option_function<std::string>(
            name, [=](const std::string& text) { (*options).*member = parse(name, text); }, description)
        ->type_name(type);
}

ViewTransform parse_view(const std::string& name, const std::string& text) {
    return parse_word(name, text, {"standard", "agx"}) == "agx" ? ViewTransform::agx : ViewTransform::standard;
}

int parse_bits(const std::string& name, const std::string& text) {
    return parse_word(name, text, {"8", "16"}) == "8" ? 8 : 16;
}

Progress::Style parse_progress(const std::string& name, const std::string& text) {
    const std::string word = parse_word(name, text, {"bar", "lines", "json", "none"});
    if (word == "bar") return Progress::Style::bar;
    if (word == "lines") return Progress::Style::farm;
    return word == "json" ? Progress::Style::json : Progress::Style::none;
}

// Adds the options that say how light and surfaces are found, and with how many samples.
void add_tracing_options(CLI::App& command, const SharedOptions& options) {
    command.add_flag("--draft", options->draft, "one sample per pixel, whatever the scene says: quick, without noise");
    command
        .add_option("--via", options->via,
                    "how surfaces are found: implicit (exact, the default), or as a mesh by " + mesh_method_names())
        ->type_name("NAME");
    add_parsed(command, options, "--accel", "bvh|embree", &RenderOptions::accel, parse_accel,
               "implicit only: find surfaces by our own BVH over BSP cells or by Embree's, with the same picture; "
               "default: bvh");
    add_parsed(command, options, "--integrator", "path|preview", &RenderOptions::integrator, parse_integrator,
               "path finds all light; preview has no noise, shadows and polished reflections; default: path from two "
               "samples per pixel on, preview with one");
    add_parsed(
        command, options, "--noise", "X", &RenderOptions::noise, parse_positive,
        "paths only: take samples until this much noise is left in each part of the picture, as a share of white "
        "on a display, 0.01: hardly seen; --spp is their limit, 4096 by default");
    add_parsed(command, options, "--time", "SECONDS", &RenderOptions::seconds, parse_positive,
               "paths only: as many samples as take about so many seconds");
}

// Adds the options of files for the screen.
void add_screen_options(CLI::App& command, const SharedOptions& options) {
    add_parsed(
        command, options, "--view", "standard|agx", &RenderOptions::view, parse_view,
        "tone curve of files for the screen, not of an EXR: standard clips what is brighter than white, agx lets "
        "it go to white softly; default: standard");
    command.add_flag("--denoise")
        ->description(
            "smooth the noise that is left, guided by normals and albedo, which an EXR then has, too: for a "
            "quick look, not for measurements. --denoise=oidn: by Intel's Open Image Denoise 2, if the system "
            "has its library")
        ->each([options](const std::string& text) {
            const std::optional<Denoiser> found = text == "true" ? Denoiser::wavelets : find_denoiser(text);
            if (!found) throw UsageError("--denoise: expected wavelets or oidn, got '" + text + "'");
            options->denoiser = *found;
        });
}

// Adds the options for pictures of meshes.
void add_facet_options(CLI::App& command, const SharedOptions& options) {
    command
        .add_option("--tolerance", options->tolerance,
                    "meshes only: the mesh's tolerance, as for mesh; default: 0.03 of each solid's least radius")
        ->type_name("D");
    command.add_flag("--flat", options->flat, "meshes only: shade each facet with one normal");
    command.add_flag("--edges", options->edges, "meshes only: draw the polygons' edges as black lines");
    command
        .add_option(
            "--wire", options->wire,
            "meshes only: draw edges alone, with hidden lines removed (visible), or all of faces towards the camera "
            "(front)")
        ->type_name("visible|front");
}

void add_pixel_options(CLI::App& command, const SharedOptions& options) {
    add_parsed(command, options, "--bits", "8|16", &RenderOptions::bits, parse_bits,
               "of each number in a PNG; default: 8");
    add_parsed(command, options, "--exposure", "E", &RenderOptions::exposure, parse_exposure,
               "of pictures for the screen, in stops: 1 shows the light twice as bright, -1 half as bright; .exr and "
               ".hdr keep the light as it is; default: the scene's");
    command.add_flag("--alpha", options->alpha,
                     "without the background that the camera sees: a PNG is transparent there, and an EXR black");
}

// Adds the options for output before the end of the run.
void add_progress_options(CLI::App& command, const SharedOptions& options) {
    add_parsed(command, options, "--write-every", "SECONDS", &RenderOptions::write_every, parse_positive,
               "write the outputs every so many seconds, too, with the samples that all pixels have by then");
    add_parsed(command, options, "--progress", "bar|lines|json|none", &RenderOptions::progress, parse_progress,
               "how stderr tells how far the work is: lines of 'Progress: 42%' and json, an object a line, are for "
               "other programs; default: a bar on a terminal, else a line now and then");
    command
        .add_option("--display-server", options->display_server,
                    "show the picture, as its samples come, in a viewer that listens there and speaks tev's protocol")
        ->type_name("HOST:PORT");
}

// Adds the options that divide the work in time and among machines.
void add_share_options(CLI::App& command, const SharedOptions& options) {
    command
        .add_option("--checkpoint", options->checkpoint,
                    "keep the sums of all samples in this file, every minute and at the end; after SIGTERM the exit "
                    "code is then 75")
        ->type_name("FILE");
    add_parsed(command, options, "--checkpoint-every", "SECONDS", &RenderOptions::checkpoint_every, parse_positive,
               "seconds from one checkpoint to the next; default: 60. SIGUSR1 asks for one at once");
    command.add_flag("--resume", options->resume,
                     "go on from the checkpoint, if there is one, to the same picture as without a break");
    add_parsed(command, options, "--frames", "a-b[/N]|auto/N", &RenderOptions::frames, parse_frames,
               "frames a to b of N, or of b, of an animation: the scene's param(\"frame\", 1) and param(\"t\", 0), "
               "which is (frame - 1) / N; names have #### for the number. auto/N: the frame of a job's array");
    add_parsed(command, options, "--tile", "i/N|auto", &RenderOptions::tile, parse_tile,
               "of N shares of the picture's rows only the one with the number i, 0 to N-1; auto: number and N of a "
               "job's array, auto/N: the number");
    add_parsed(command, options, "--samples", "a-b", &RenderOptions::samples, parse_samples,
               "of the samples that --spp says only a to b-1, the first is 0, into the checkpoint: a part for merge");
}

}  // namespace

CLI::App* add_render_options(CLI::App& program, const std::shared_ptr<RenderOptions>& options) {
    CLI::App* command = program.add_subcommand("render", "render a scene to image files");
    add_scene_options(*command, *options);
    add_output_option(*command, *options, known_extensions());
    add_picture_options(*command, *options, "the scene's, or as many as leave hardly any noise, 16 to 256");
    add_tracing_options(*command, options);
    add_screen_options(*command, options);
    add_facet_options(*command, options);
    add_pixel_options(*command, options);
    add_progress_options(*command, options);
    add_share_options(*command, options);
    add_run_options(*command, *options);
    add_statistics_options(*command, *options);
    return command;
}

}  // namespace deburr
