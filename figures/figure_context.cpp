#include "figures/figure_context.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "figures/figure.hpp"
#include "figures/plot.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/image/image_file.hpp"
#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"
#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {

namespace fs = std::filesystem;

FigureContext::FigureContext(const Figure& figure, std::string scene_folder, std::string output_folder, bool draft)
    : figure_(figure),
      scene_folder_(std::move(scene_folder)),
      output_folder_(std::move(output_folder)),
      draft_(draft) {}

Scene FigureContext::scene(const std::string& file, const std::map<std::string, std::string>& parameters) const {
    if (!std::count(figure_.scenes.begin(), figure_.scenes.end(), file))
        throw std::logic_error(fmt::format("{} reads '{}', which is not among its scenes", figure_.name, file));
    Options options;
    options.scene = (fs::path(scene_folder_) / file).string();
    options.defines = parameters;
    return load_scene(options);
}

Film FigureContext::render(const Scene& scene, const FigurePictureSettings& settings) const {
    return render(scene, ImplicitTracer(scene.solids), settings);
}

Film FigureContext::render(const Scene& scene, const RayTracer& tracer, const FigurePictureSettings& settings) const {
    // A draft has half the width and height, and a sixteenth of the samples.
    const int shrink = draft_ ? 2 : 1, fewer = draft_ ? 16 : 1;
    const int width = std::max(1, (settings.width ? settings.width : scene.width) / shrink);
    const int height = std::max(1, (settings.height ? settings.height : scene.height) / shrink);
    const int spp = std::max(1, (settings.spp ? settings.spp : scene.spp.value_or(1)) / fewer);
    RenderSettings rendering{width, height, spp, 0};
    if (settings.noise > 0 && !draft_) {
        rendering.noise = settings.noise;
        rendering.spp *= 16;
    }
    const Integrator integrator(scene, tracer, rendering);
    Film film =
        deburr::render(Film(width, height, {0, 0, width, height}), [&](const Window& block, Pixel* pixels,
                                                                       PixelLayers* layers, TraceCounters& counters) {
            integrator.block(block, pixels, layers, counters);
        }).film;
    // A figure shows the scene with the exposure of its pictures for the screen.
    for (Pixel& pixel : film.pixels) pixel.color *= std::exp2(scene.exposure);
    return film;
}

std::string FigureContext::next_file(const std::string& suffix) const {
    std::string end = suffix;
    std::size_t pictures = 0;
    for (const FigureItem& item : result_.items) pictures += !item.file.empty();
    if (end.empty() && (pictures > 0 || result_.columns > 1)) end = std::string(1, char('a' + pictures));
    return figure_.name + (end.empty() ? "" : "-" + end);
}

void FigureContext::picture(const Film& film, const std::string& caption, std::string suffix) {
    FigureItem item;
    item.file = next_file(suffix) + ".png";
    item.caption = caption;
    item.width = film.window.width;
    write_image((fs::path(output_folder_) / item.file).string(), film, {}, {});
    result_.items.push_back(std::move(item));
}

void FigureContext::picture_bytes(std::string_view png, int width, const std::string& caption, std::string suffix) {
    FigureItem item;
    item.file = next_file(suffix) + ".png";
    item.caption = caption;
    item.width = width;
    write_whole_file((fs::path(output_folder_) / item.file).string(), png);
    result_.items.push_back(std::move(item));
}

void FigureContext::plot(const Plot& plot, const std::string& caption, std::string suffix) {
    if (!figure_.plots) throw std::logic_error(figure_.name + " makes a plot, but does not say so");
    FigureItem item;
    const std::string name = next_file(suffix);
    item.file = name + ".png";
    item.others = {name + ".svg"};
    item.caption = caption;
    item.width = plot.width;
    const PlotImages images = draw(plot);
    write_whole_file((fs::path(output_folder_) / item.file).string(), images.png);
    write_whole_file((fs::path(output_folder_) / item.others[0]).string(), images.svg);
    result_.items.push_back(std::move(item));
}

void FigureContext::also(const std::string& extension, std::string_view bytes) {
    FigureItem& item = result_.items.back();
    const std::string file = fs::path(item.file).stem().string() + extension;
    write_whole_file((fs::path(output_folder_) / file).string(), bytes);
    item.others.push_back(file);
}

void FigureContext::table(FigureTable table) {
    FigureItem item;
    item.table = std::move(table);
    result_.items.push_back(std::move(item));
}

void FigureContext::measured(const std::string& sentence) { result_.measured.push_back(sentence); }

}  // namespace deburr
