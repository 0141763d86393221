// The command line's options. Those that several commands share are added here, so that they are
// spelled, explained and checked alike everywhere.
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

struct Options {
    std::string scene;
    std::map<std::string, std::string> defines;  // -D
    std::vector<std::string> model_folders;      // --model-path
    ModelSettings model;                         // of a model file in place of a scene
    bool is_model_option_given = false;
    bool model_only = false;  // the solids of a model, without a ground

    std::vector<std::string> outputs;  // -o

    std::optional<Size> size;
    std::optional<int> spp;
    std::optional<Window> crop;
    bool frame = false;        // --frame
    std::optional<Vec3> from;  // --from, which implies it
    std::uint64_t seed = 0;
    std::vector<ImageLayer> layers;  // --aov
    bool float_color = false;
    Criterion criterion = Criterion::exact;

    std::optional<int> threads;
    bool quiet = false, verbose = false;

    bool stats = false;
    std::string stats_json;
};

/// Each adds a group of options to a command and keeps a reference to `options`.
void add_scene_options(CLI::App& command, Options& options);  // SCENE -D
/// -o. `more` is what its help says besides the formats.
void add_output_option(CLI::App& command, Options& options, const std::string& formats, const std::string& more = "");
void add_view_options(CLI::App& command, Options& options);  // --size --frame --from
/// Those, --spp --crop --seed …; `default_spp` is what its help says of the default.
void add_picture_options(CLI::App& command, Options& options, const std::string& default_spp);
void add_run_options(CLI::App& command, Options& options);         // --threads -q -v
void add_statistics_options(CLI::App& command, Options& options);  // --stats --stats-json

/// The scene that the options name, with their parameters, its camera placed for the picture's size. Throws UsageError
/// if there is none or if it does not ask for a parameter that was given, SceneError if it is wrong.
Scene load_scene(const Options& options);

/// The whole picture's size: --size, or else what the scene says.
Size picture_size(const Options& options, const Scene& scene);

/// The part of it that is rendered: --crop, or all. Throws UsageError if it does not lie in the picture or is too much,
/// WorkError if `bytes_per_pixel` of it are more than the machine has.
Window picture_window(const Options& options, const Scene& scene, double bytes_per_pixel);

}  // namespace deburr
