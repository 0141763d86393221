// What a figure's function works with: scenes, renderings, and places to put what comes of them.
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

/// Cells as text; they may hold Markdown, but no line ends.
struct FigureTable {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

/// One thing on the page: a picture or a table.
struct FigureItem {
    std::string file;                 // PNG, "" for a table
    std::vector<std::string> others;  // the same in other formats
    std::string caption;
    int width = 0;  // on the page, pixels
    FigureTable table;
};

struct FigureResult {
    std::vector<FigureItem> items;
    std::vector<std::string> measured;
    int columns = 1;  // of pictures on the page
};

struct FigurePictureSettings {
    int width = 0, height = 0;  // 0: the scene's
    int spp = 0;                // 0: the scene's
    double noise = 0;           // > 0: samples until this little noise is left, 16 times `spp` at most
};

class FigureContext {
public:
    /// Keeps references.
    FigureContext(const Figure& figure, std::string scene_folder, std::string output_folder, bool draft);

    /// Reads a scene that the figure names.
    Scene scene(const std::string& file, const std::map<std::string, std::string>& parameters = {}) const;
    /// The implicit surfaces, or whatever `tracer` sees.
    Film render(const Scene& scene, const FigurePictureSettings& settings = {}) const;
    Film render(const Scene& scene, const RayTracer& tracer, const FigurePictureSettings& settings = {}) const;

    /// Write NAME.png, or NAME-SUFFIX.png and, of a plot, also the .svg. Suffixes are a, b, c, … where
    /// none is given and there are several pictures: call columns() first then.
    void picture(const Film& film, const std::string& caption = "", std::string suffix = "");
    void plot(const Plot& plot, const std::string& caption = "", std::string suffix = "");
    /// A PNG's bytes, made by the caller; `width` in pixels.
    void picture_bytes(std::string_view png, int width, const std::string& caption = "", std::string suffix = "");
    /// A file in another format, made by the caller: the bytes, and the extension with its dot. It
    /// goes with the picture before it.
    void also(const std::string& extension, std::string_view bytes);
    void table(FigureTable table);
    /// A sentence with what this run found.
    void measured(const std::string& sentence);
    /// How many of the pictures stand side by side on the page.
    void columns(int n) { result_.columns = n; }

    /// Quick and rough: fewer samples and smaller pictures.
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
