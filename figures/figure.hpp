// A figure or table of the papers, reproduced by the program.
//
// To add one, write a file figures/PAPER_WHAT.cpp with only this:
//
//     #include "figures/figure.hpp"
//
//     namespace deburr {
//     namespace {
//
//     void make(FigureContext& context) {
//         const Scene scene = context.scene("variable_rounding.lua", {{"r", "0.1"}});
//         context.picture(context.render(scene, {.spp = 64}), "(a) implicit");
//         context.measured(fmt::format("The largest radius is {}.", …));
//     }
//
//     const RegisteredFigure registered{{
//         .name = "lobb-13",
//         .title = "Figure 13: the radius grows",
//         .shows = "One sentence: what one sees.",
//         .claim = "What the paper says, with its number.",
//         .scenes = {"variable_rounding.lua"},
//         .make = make,
//     }};
//
//     }  // namespace
//     }  // namespace deburr
//
// CMake finds the file; list, page and updates follow. Rules:
//   - The name is lobb-, triage-, vyatkin- or beyond-, and the figure's number or table-NUMBER.
//   - Every scene that `make` reads is in `scenes`: the figure is made again when one of them changes.
//   - `plots` is true if `make` calls plot(), which needs gnuplot.
//   - No number is written by hand: measured() takes what this run computed, and `claim` what the paper
//     prints. The same program and scenes give the same pictures.
//   - `seconds` is a rough guess on two cores, for the progress bar.
// Curves, fields, arrows and labels: figures/plot.hpp. Pictures of meshes: figures/studio.hpp.
#pragma once
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "figures/figure_context.hpp"

namespace deburr {

/// The description of a figure.
struct Figure {
    std::string name = {};                 // such as "lobb-13"
    std::string title = {};                // as on the page
    std::string shows = {};                // a sentence: what one sees
    std::string claim = {};                // what the paper claims, with its number
    std::vector<std::string> scenes = {};  // files in the folder scenes/
    bool plots = false;                    // whether `make` calls plot()
    double seconds = 2;                    // rough time to make it, for the progress bar
    std::function<void(FigureContext&)> make = {};
};

/// All figures, by paper and number.
const std::vector<Figure>& all_figures();

/// The figures that `words` name, which are names of figures or of papers; all if there are no words. Throws UsageError
/// for an unknown word.
std::vector<Figure> find_figures(const std::vector<std::string>& words);

/// The paper of a figure, such as "Lobb 1996" for lobb-12.
std::string paper_of(const Figure& figure);

/// Adds a figure to all_figures(); for variables at namespace scope in the figures' files.
class RegisteredFigure {
public:
    explicit RegisteredFigure(Figure figure);
};

}  // namespace deburr
