// `deburr merge PART … -o FILE …`: combines parts that were rendered separately into one picture.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "raytracer/cli/commands.hpp"
#include "raytracer/cli/farm_options.hpp"
#include "raytracer/cli/options.hpp"
#include "raytracer/cli/render_pictures.hpp"
#include "raytracer/cli/sums_file.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/util/whole_file.hpp"

namespace deburr {
namespace {

struct MergeOptions : Options {
    std::vector<std::string> parts;
};

struct Part {
    std::string path;
    nlohmann::ordered_json head;
    Window window;
    SampleRange samples;
};

std::string text_of(const Part& part) {
    const Window& w = part.window;
    return fmt::format("{} (samples {}-{}, {}x{}+{}+{})", part.path, part.samples.first, part.samples.end, w.width,
                       w.height, w.x, w.y);
}

Part read_part(const std::string& path) {
    Part part{path, read_sums(path).head, {}, {}};
    part.window = window_of(part.head.at("window"));
    part.samples = {part.head.at("samples").at(0), part.head.at("samples").at(1)};
    if (!part.head.at("finished").get<bool>())
        throw UsageError(path + ": expected a part that is finished, got one that --resume has to go on with");
    return part;
}

void check_of_one_picture(const std::vector<Part>& parts) {
    for (const Part& part : parts)
        for (const char* key : {"scene", "size", "whole", "spp", "noise", "layers"})
            if (part.head.at(key) != parts[0].head.at(key))
                throw UsageError(
                    fmt::format("{}: expected a part of the picture that {} is of, got one of another ({})", part.path,
                                parts[0].path, std::string(key) == "scene" ? "scene or options" : key));
}

// Throws unless the parts, which are rows and samples, contain every sample of every row exactly once.
void check_whole(std::vector<Part> parts) {
    const Window whole = window_of(parts[0].head.at("whole"));
    const int spp = parts[0].head.at("spp");
    std::set<int> rows{whole.y, whole.y + whole.height};
    for (const Part& part : parts)
        for (const int row : {part.window.y, part.window.y + part.window.height}) rows.insert(row);
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.samples.first < b.samples.first; });
    for (auto row = rows.begin(); std::next(row) != rows.end(); ++row) {
        int next = 0;
        const Part* before = nullptr;
        const auto missing = [&](int end) {
            throw UsageError(
                fmt::format("merge: expected all parts, got none with the samples {}-{} of the rows {} to {}", next,
                            end, *row, *std::next(row) - 1));
        };
        for (const Part& part : parts) {
            if (part.window.y > *row || part.window.y + part.window.height <= *row) continue;
            if (part.samples.first < next)
                throw UsageError(fmt::format("merge: expected parts that do not overlap, got {} and {}",
                                             text_of(*before), text_of(part)));
            if (part.samples.first > next) missing(part.samples.first);
            next = part.samples.end;
            before = &part;
        }
        if (next < spp) missing(spp);
    }
}

// The sums of a picture's parts, added in the order of their samples.
class Sum {
public:
    Sum(const Part& any, std::vector<ImageLayer> layers)
        : layers_(std::move(layers)),
          width_(any.head.at("size").at(0)),
          height_(any.head.at("size").at(1)),
          whole_(window_of(any.head.at("whole"))),
          sums_(std::size_t(whole_.width) * std::size_t(whole_.height)),
          layer_sums_(layers_.empty() ? 0 : sums_.size()) {}

    void add(const Part& part) {
        Passes passes({width_, height_, part.window, layers_, part.samples, part.head.at("noise")}, nullptr);
        if (!passes.restore(read_sums(part.path).bytes))
            throw WorkError(part.path + ": expected the sums of its head, got others");
        const Window& w = part.window;
        for (std::size_t i = 0, end = std::size_t(w.width) * std::size_t(w.height); i < end; ++i) {
            const std::size_t to =
                std::size_t(w.y - whole_.y + int(i / std::size_t(w.width))) * std::size_t(whole_.width) +
                std::size_t(w.x - whole_.x) + i % std::size_t(w.width);
            const bool first = sums_[to].samples == 0;
            sums_[to] += passes.sums_at(i);
            if (layers_.empty()) continue;
            if (first)
                layer_sums_[to] = passes.layers_at(i);
            else
                layer_sums_[to] += passes.layers_at(i);
        }
    }

    Film film() const {
        Film film(width_, height_, whole_, layers_);
        std::vector<PixelLayers> row(layers_.empty() ? 0 : std::size_t(whole_.width));
        for (int y = 0; y < whole_.height; ++y) {
            for (int x = 0; x < whole_.width; ++x) {
                const std::size_t i = std::size_t(y) * std::size_t(whole_.width) + std::size_t(x);
                film.pixels[i] = mean(sums_[i]);
                if (!layers_.empty()) row[std::size_t(x)] = mean(layer_sums_[i], sums_[i].samples);
            }
            if (!layers_.empty()) film.set_layers({whole_.x, whole_.y + y, whole_.width, 1}, row.data());
        }
        return film;
    }

private:
    std::vector<ImageLayer> layers_;
    int width_, height_;
    Window whole_;
    std::vector<PixelSums> sums_;
    std::vector<LayerSums> layer_sums_;
};

int run_merge(const MergeOptions& o) {
    if (o.parts.empty()) throw UsageError("merge: expected parts, files by --checkpoint, got none");
    if (o.outputs.empty()) throw UsageError("merge: expected an output file, -o FILE");
    check_image_names("-o", o.outputs);
    check_outputs(o.outputs, {}, o.parts);
    for (const std::string& path : o.outputs) check_writable(path);
    std::vector<Part> parts;
    for (const std::string& path : o.parts) parts.push_back(read_part(path));
    check_of_one_picture(parts);
    check_whole(parts);
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.samples.first < b.samples.first; });
    std::vector<ImageLayer> layers;
    for (const std::string name : parts[0].head.at("layers")) layers.push_back(*find_layer(name));
    Sum sum(parts[0], layers);
    for (const Part& part : parts) sum.add(part);

    ImageNotes notes;
    ImageFormat format;
    Denoiser denoiser = Denoiser::none;
    read_notes(parts[0].head.at("notes"), notes, format, denoiser);
    notes.spp = parts[0].head.at("spp");
    notes.date = picture_date();
    format.threads = default_threads();
    Film film = sum.film();
    denoise(film, denoiser, format.threads);
    write_pictures(o.outputs, film, format, notes, [](double) {});
    return 0;
}

}  // namespace

Command add_merge_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("merge", "one picture of parts that were rendered apart");
    const auto options = std::make_shared<MergeOptions>();
    command
        ->add_option("PART", options->parts, "files by render --checkpoint with --tile or --samples: all of a picture")
        ->type_name("");
    add_output_option(*command, *options, known_extensions());
    return {command, [options] { return run_merge(*options); }};
}

}  // namespace deburr
