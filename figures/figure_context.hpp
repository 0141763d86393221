// The interface for functions that make figures: reading scenes, rendering, and adding results to the page.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

struct Figure;
struct Plot;

/// A table of texts, which may be Markdown but must not contain newlines.
struct FigureTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// An item on the page: a picture or a table.
struct FigureItem {
    std::string file;                 // PNG; "": a table
    std::vector<std::string> others;  // the same in other formats
    std::string caption;
    int width = 0;  // on the page, in pixels
    FigureTable table;
};

/// Everything that a figure's function has produced.
struct FigureResult {
    std::vector<FigureItem> items;
    std::vector<std::string> measured;
    int columns = 1;  // pictures side by side on the page
};

/// Overrides of a scene's picture settings.
struct FigurePictureSettings {
    int width = 0, height = 0;  // 0: the scene's
    int spp = 0;                // 0: the scene's
    double noise = 0;           // > 0: noise bound, with at most 16 times `spp` samples
};

/// The context of one figure.
class FigureContext {
public:
    /// Keeps a reference to the figure. With `draft`, pictures are small and have few samples.
    FigureContext(const Figure& figure, std::string scene_folder, std::string output_folder, bool draft);

    /// Reads a scene, which must be one of the figure's `scenes`.
    Scene scene(const std::string& file, const std::map<std::string, std::string>& parameters = {}) const;
    /// A picture of the scene's implicit surfaces, or of what `tracer` sees.
    Film render(const Scene& scene, const FigurePictureSettings& settings = {}) const;
    Film render(const Scene& scene, const RayTracer& tracer, const FigurePictureSettings& settings = {}) const;

    /// Each of these writes NAME.png or NAME-SUFFIX.png (of a plot also .svg) and adds it to the page. Default suffixes
    /// are a, b, c, …, if there are several pictures; in that case columns() must be called first.
    void picture(const Film& film, const std::string& caption = "", std::string suffix = "");
    void plot(const Plot& plot, const std::string& caption = "", std::string suffix = "");
    /// A PNG that the caller has encoded; `width` in pixels.
    void picture_bytes(std::string_view png, int width, const std::string& caption = "", std::string suffix = "");
    /// A file in another format that the caller has encoded, which belongs to the latest picture; `extension` includes
    /// the dot.
    void also(const std::string& extension, std::string_view bytes);
    void table(FigureTable table);
    /// Adds a sentence with a result of this run.
    void measured(const std::string& sentence);
    /// Sets how many pictures stand side by side on the page.
    void columns(int n) { result_.columns = n; }

    /// Whether pictures are drafts: small, with few samples.
    bool draft() const { return draft_; }
    const FigureResult& result() const { return result_; }

private:
    std::string next_file(const std::string& suffix) const;

    const Figure& figure_;
    std::string scene_folder_, output_folder_;
    bool draft_;
    FigureResult result_;
};

}  // namespace deburr
