#include <algorithm>

#include "raytracer/bsp.hpp"
#include "raytracer/spaces.hpp"

namespace deburr {

namespace {

FoundSurface find(const std::vector<Space>& all, const Space& space, const Ray& ray, double t_max, bool any, TraceCounters& counters);

// What is placed in a space. It sees the ray with a unit direction of its own, so that tolerances mean
// there what they mean here; distances along it are longer by `rate`.
class Placed final : public Others {
public:
    Placed(const std::vector<Space>& all, const Space& space) : all_(all), space_(space) {}

    FoundSurface find(std::uint32_t number, const Ray& ray, double t_max, bool any, TraceCounters& counters) const override {
        ++counters.placements;
        const Placement& p = space_.placements[number];
        Ray there{ray.origin + p.into.shift, ray.direction};
        double rate = 1;
        if (!p.only_moved) {
            there = {p.into(ray.origin), p.into.linear * ray.direction};
            rate = glm::length(there.direction);
            there.direction /= rate;
        }
        FoundSurface found = deburr::find(all_, all_[std::size_t(p.space)], there, t_max * rate, any, counters);
        if (!(found.crossing.t < infinity)) return {};
        found.crossing.t /= rate;
        if (!any && !p.only_moved) found.crossing.normal = glm::normalize(found.crossing.normal * p.into.linear);  // by the transpose
        if (found.crossing.material < 0) found.crossing.material = p.material;
        found.solid = p.solid;
        found.error = found.error * p.stretch + 4 * epsilon * (largest(ray.origin) + found.crossing.t);
        return found;
    }

private:
    const std::vector<Space>& all_;
    const Space& space_;
};

FoundSurface find(const std::vector<Space>& all, const Space& space, const Ray& ray, double t_max, bool any, TraceCounters& counters) {
    const Placed placed(all, space);
    return space.bsp.find(ray, t_max, any, counters, &placed);
}

}  // namespace

struct ImplicitTracer::Spaces {
    std::vector<Space> all;

    FoundSurface find(const Ray& ray, double t_max, bool any, TraceCounters& counters) const {
        return deburr::find(all, all[0], ray, t_max, any, counters);
    }
};

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion, Search search)
    : spaces_(new Spaces{build_spaces(solids, criterion, search)}) {}

ImplicitTracer::~ImplicitTracer() = default;

Hit ImplicitTracer::first_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const FoundSurface found = spaces_->find(ray, t_max, false, counters);
    if (!(found.crossing.t < infinity)) return {};
    Hit hit;
    hit.t = found.crossing.t;
    hit.position = ray.origin + ray.direction * hit.t;
    hit.normal = found.crossing.normal;
    hit.solid = found.solid;
    hit.material = std::max(0, found.crossing.material);
    // Far beyond the error of the position, far below anything to be seen.
    hit.offset = 128 * found.error;
    return hit;
}

bool ImplicitTracer::occluded(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    return spaces_->find(ray, t_max, true, counters).crossing.t < infinity;
}

BspStatistics ImplicitTracer::statistics() const {
    BspStatistics s;
    std::size_t local = 0;
    for (const Space& space : spaces_->all) {
        const Pieces& pieces = space.bsp.pieces();
        s.placements += space.placements.size() + space.bsp.trees().size() - 1;
        std::uint32_t first = 0;  // piece of the tree
        for (const BspTree& tree : space.bsp.trees()) {
            ++s.spaces;
            s.cells += tree.cells.size();
            s.half_spaces += tree.half_spaces;
            s.depth = std::max(s.depth, tree.depth);
            for (const BspCell& cell : tree.cells) {
                bool flat = cell.count > 0;
                for (std::uint32_t i = first + cell.first; i < first + cell.first + cell.count; ++i) {
                    local += pieces.half_spaces(i);
                    flat &= pieces[i].kind == Piece::Kind::plane;
                }
                s.empty_cells += cell.count == 0;
                s.flat_cells += flat;
            }
            if (!tree.cells.empty()) first += tree.cells.back().first + tree.cells.back().count;
        }
    }
    if (s.cells > s.empty_cells) s.mean_local_half_spaces = double(local) / double(s.cells - s.empty_cells);
    return s;
}

}  // namespace deburr
