// The page that shows an album's figures, in Markdown: what each shows, what the paper claims of it,
// and what was measured.
#pragma once
#include <string>
#include <vector>

#include "figures/figure.hpp"

namespace deburr {

struct ShownFigure {
    const Figure* figure;
    const FigureResult* result;
};

/// `folder` is where the page will be, for the links to scenes.
std::string page_of(const std::vector<ShownFigure>& figures, const std::string& folder,
                    const std::string& scene_folder);

}  // namespace deburr
