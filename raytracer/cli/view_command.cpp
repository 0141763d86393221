// `deburr view FILE`: a page in the browser that shows the exact picture while the file is being edited.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "polygonizer/mesh/export.hpp"
#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/render_pictures.hpp"
#include "raytracer/image/scene_pictures.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/scene/vanished_parts.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/interrupt.hpp"
#include "raytracer/util/temporary_folder.hpp"
#include "raytracer/view/file_watch.hpp"
#include "raytracer/view/view_server.hpp"

namespace deburr {
namespace {

struct ViewOptions : RenderOptions {
    int port = 0;
};

// Interval in milliseconds at which Ctrl-C is noticed.
constexpr int poll_interval = 100;

// The bytes that `deburr render` or `deburr mesh` would write for this extension.
std::string encoded(const RenderOptions& o, const std::string& extension, const Scene& scene, const Film* film,
                    int samples) {
    if (extension == ".stl") {
        MeshSettings settings;
        settings.triage_tolerance_in_radii = default_tolerance_in_radii;
        settings.leave_out_unbounded = true;
        return encode(mesh_scene(scene, settings).mesh, MeshFormat::stl);
    }
    RenderWorld world;
    world.scene = scene;
    const TemporaryFolder folder;
    const std::string path = folder / ("picture" + extension);
    write_image(path, *film, format_of(o, exposure_of(o, scene), default_threads()), notes_of(o, world, samples, 0));
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

int run_view(const ViewOptions& o) {
    if (o.scene.empty()) throw UsageError("view: expected a scene or a model file");
    if (!std::filesystem::exists(o.scene)) throw UsageError(o.scene + ": expected a file that is there");
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    std::size_t(o.threads.value_or(default_threads())));
    std::mutex mutex;
    std::vector<std::string> files = {o.scene};
    const auto load = [&](const std::map<std::string, std::string>& parameters) {
        Options options = o;
        options.quiet = true;
        for (const auto& [name, value] : parameters) options.defines[name] = value;
        Scene scene = load_scene(options);
        load_pictures(scene);
        const Size size = picture_size(options, scene);
        scene.width = size.width;
        scene.height = size.height;
        check_pixels("--size", {0, 0, size.width, size.height});
        if (nothing_is_left(scene)) throw WorkError(scene.file + ": no solid is left, and there is nothing to show");
        const std::lock_guard lock(mutex);
        files = scene.model_files;
        files.push_back(o.scene);
        return scene;
    };
    LivePicture picture(load, {o.spp, o.view});
    const ViewServer server(
        picture, std::filesystem::path(o.scene).filename().string(),
        [&o](const std::string& extension, const Scene& scene, const Film* film, int samples) {
            return encoded(o, extension, scene, film, samples);
        },
        o.port);
    fmt::print("{}\n", server.address());
    std::fflush(stdout);
    const std::atomic<bool>& stop = catch_interrupts(false);
    FileWatch watch;
    std::vector<std::string> watched;
    while (!stop) {
        {
            const std::lock_guard lock(mutex);
            if (files != watched) watch.set_files(watched = files);
        }
        if (watch.wait(poll_interval)) picture.reload();
    }
    return 0;
}

}  // namespace

Command add_view_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("view", "show a scene in the browser while it is being edited");
    const auto options = std::make_shared<ViewOptions>();
    add_scene_options(*command, *options);
    add_view_options(*command, *options);
    command
        ->add_option_function<std::string>(
            "--spp",
            [options](const std::string& text) { options->spp = int(parse_whole("--spp", text, 1, max_samples)); },
            "samples per pixel at the end; default: the scene's, or as many as leave hardly any noise")
        ->type_name("N");
    command
        ->add_option_function<std::string>(
            "--port",
            [options](const std::string& text) { options->port = int(parse_whole("--port", text, 0, 65535)); },
            "of the page's address, http://127.0.0.1:PORT/…; default: any that is free")
        ->type_name("PORT");
    add_run_options(*command, *options);
    return {command, [options] { return run_view(*options); }};
}

}  // namespace deburr
