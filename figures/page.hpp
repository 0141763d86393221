// The page of an album in Markdown: what each figure shows, what the paper claims, and what was measured.
#pragma once
#include <string>
#include <vector>

#include "figures/figure.hpp"

namespace deburr {

/// A figure on the page.
struct ShownFigure {
    const Figure* figure;
    const FigureResult* result;
};

/// The text of the page; `folder` is where it will be, for links to scenes.
std::string page_of(const std::vector<ShownFigure>& figures, const std::string& folder,
                    const std::string& scene_folder);

}  // namespace deburr
