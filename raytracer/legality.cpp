#include "raytracer/legality.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bounds/legality.hpp"
#include "bounds/solid_tree.hpp"

namespace deburr {

std::vector<std::string> illegal_densities(const Scene& scene, int boxes) {
    std::vector<std::string> lines;
    std::vector<std::pair<int, Op>> told;
    for (const Solid& solid : scene.solids)
        for (const SolidLeaf& leaf : flatten(solid).leaves)
            for (const IllegalDensity& d : find_illegal(leaf.density, boxes)) {
                const std::pair<int, Op> place{d.line, d.op};
                if (std::find(told.begin(), told.end(), place) != told.end()) continue;
                told.push_back(place);
                const std::string where = d.line > 0 ? fmt::format("{}:{}", scene.file, d.line) : scene.file;
                const bool above = d.value > 1;
                const char* why = d.op == Op::sum ? "its parts overlap: use |"
                                  : above         ? "what it subtracts from is illegal"
                                                  : "what it subtracts sticks out: clip it, or use & ~";
                lines.push_back(fmt::format("{}: {}: expected a density of at {}, got {:.4g} at ({:.4g}, {:.4g}, {:.4g}); {}",
                                            where, d.op == Op::sum ? "sum" : "difference",
                                            above ? "most 1" : "least 0", d.value, d.point.x, d.point.y,
                                            d.point.z, why));
            }
    return lines;
}

}  // namespace deburr
