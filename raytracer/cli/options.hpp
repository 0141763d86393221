// Options of the command line that several commands share, so that they are spelled, explained and checked alike.
#pragma once
#include <CLI/App.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "raytracer/cli/option_values.hpp"
#include "raytracer/scene/model_scene.hpp"
#include "raytracer/scene/scene.hpp"

namespace deburr {

/// The shared options as parsed. A comment names the option where it is not obvious.
struct Options {
    std::string scene;
    std::map<std::string, std::string> defines;  // -D
    std::vector<std::string> model_folders;      // --model-path
    ModelSettings model;                         // for a model file instead of a scene
    bool is_model_option_given = false;
    bool model_only = false;  // show a model's solid only, without ground

    std::vector<std::string> outputs;  // -o

    std::optional<Size> size;
    std::optional<int> spp;
    std::optional<Window> crop;
    bool frame = false;        // --frame
    std::optional<Vec3> from;  // --from, which implies --frame
    std::uint64_t seed = 0;
    std::vector<ImageLayer> layers;  // --aov
    bool float_color = false;
    Criterion criterion = Criterion::exact;

    std::optional<int> threads;
    bool quiet = false, verbose = false;

    bool stats = false;
    std::string stats_json;
};

/// Each of these functions adds a group of options to a command and keeps a reference to `options`.
void add_scene_options(CLI::App& command, Options& options);  // SCENE -D
/// Adds -o. `more` is appended to the formats in its help.
void add_output_option(CLI::App& command, Options& options, const std::string& formats, const std::string& more = "");
void add_view_options(CLI::App& command, Options& options);  // --size --frame --from
/// Adds the view options, --spp, --crop, --seed and further ones; `default_spp` describes the default in the help.
void add_picture_options(CLI::App& command, Options& options, const std::string& default_spp);
void add_run_options(CLI::App& command, Options& options);         // --threads -q -v
void add_statistics_options(CLI::App& command, Options& options);  // --stats --stats-json

/// Reads the scene that the options name, with their parameters, and places its camera for the picture's size. Throws
/// UsageError if no scene is named or it does not ask for a given parameter, and SceneError if it is wrong.
Scene load_scene(const Options& options);

/// The size of the whole picture: --size, or else the scene's.
Size picture_size(const Options& options, const Scene& scene);

/// The part of the picture that is rendered: --crop, or all of it. Throws UsageError if it is not within the picture or
/// too large, and WorkError if its memory (bytes_per_pixel) exceeds the machine's.
Window picture_window(const Options& options, const Scene& scene, double bytes_per_pixel);

}  // namespace deburr
