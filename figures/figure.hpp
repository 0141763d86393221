// A figure or table of the papers, made anew from the program itself.
//
// To add one, write a file figures/PAPER_WHAT.cpp with nothing but this:
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
// CMake finds the file, and the list, the page and the remaking follow. Rules:
//   - The name is lobb-, triage-, vyatkin- or beyond-, and the figure's number or table-NUMBER.
//   - Every scene that `make` reads is in `scenes`: the figure is made again when one changes.
//   - `plots` is true if `make` calls plot(): gnuplot must be there then.
//   - No number is written by hand: measured() takes what this run computed, and the claim what the
//     paper prints. The same program and scenes give the same pictures.
//   - `seconds` is a rough guess on two cores, for the progress bar.
// Curves, fields, arrows and labels: figures/plot.hpp. Pictures of meshes: figures/studio.hpp.
#pragma once
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "figures/figure_context.hpp"

namespace deburr {

struct Figure {
    std::string name = {};
    std::string title = {};
    std::string shows = {};
    std::string claim = {};
    std::vector<std::string> scenes = {};  // files of the folder scenes/
    bool plots = false;
    double seconds = 2;
    std::function<void(FigureContext&)> make = {};
};

/// All of them, paper after paper, by number.
const std::vector<Figure>& all_figures();

/// The figures that the words name: names, or papers for all of theirs; no words: all. Throws
/// UsageError for a word that is neither.
std::vector<Figure> find_figures(const std::vector<std::string>& words);

/// "Lobb 1996" for lobb-12.
std::string paper_of(const Figure& figure);

/// Adds a figure to all_figures(); for variables in the figures' files.
class RegisteredFigure {
public:
    explicit RegisteredFigure(Figure figure);
};

}  // namespace deburr
