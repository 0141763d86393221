#include <algorithm>

#include "raytracer/bsp.hpp"
#include "raytracer/spaces.hpp"

namespace deburr {

struct ImplicitTracer::Spaces {
    std::vector<Space> all;

    FoundSurface find(const Space& space, const Ray& ray, double t_max, bool any, TraceCounters& counters) const;
};

// A placed space sees the ray with a unit direction of its own, so that tolerances mean there what
// they mean here; distances along it are longer by `rate`.
FoundSurface ImplicitTracer::Spaces::find(const Space& space, const Ray& ray, double t_max, bool any,
                                          TraceCounters& counters) const {
    FoundSurface best;
    if (!space.solids.empty()) {
        best = space.bsp.find(ray, t_max, any, counters);
        if (best.crossing.t < infinity) {
            best.solid = space.solids[std::size_t(best.solid)];
            if (any) return best;
        }
    }
    double limit = std::min(t_max, best.crossing.t);
    space.hierarchy.along(ray, limit, [&](int number) {
        ++counters.placements;
        const Placement& p = space.placements[std::size_t(number)];
        Ray there{ray.origin + p.into.shift, ray.direction};
        double rate = 1;
        if (!p.only_moved) {
            there = {p.into(ray.origin), p.into.linear * ray.direction};
            rate = glm::length(there.direction);
            there.direction /= rate;
        }
        FoundSurface found = find(all[std::size_t(p.space)], there, limit * rate, any, counters);
        const double t = found.crossing.t / rate;
        if (!(t < best.crossing.t)) return false;
        best.crossing.t = limit = t;
        best.crossing.normal = found.crossing.normal;
        if (!any && !p.only_moved) best.crossing.normal = glm::normalize(found.crossing.normal * p.into.linear);  // by the transpose
        best.crossing.material = found.crossing.material < 0 ? p.material : found.crossing.material;
        best.solid = p.solid;
        const Vec3 o = glm::abs(ray.origin);
        best.error = found.error * p.stretch + 4 * epsilon * (std::max({o.x, o.y, o.z}) + t);
        return any;
    });
    return best;
}

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion, Search search)
    : spaces_(new Spaces{build_spaces(solids, criterion, search)}) {}

ImplicitTracer::~ImplicitTracer() = default;

Hit ImplicitTracer::first_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const FoundSurface found = spaces_->find(spaces_->all[0], ray, t_max, false, counters);
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
    return spaces_->find(spaces_->all[0], ray, t_max, true, counters).crossing.t < infinity;
}

BspStatistics ImplicitTracer::statistics() const {
    BspStatistics s;
    std::size_t local = 0;
    for (const Space& space : spaces_->all) {
        const BspTree& tree = space.bsp.tree();
        const Pieces& pieces = space.bsp.pieces();
        ++s.spaces;
        s.placements += space.placements.size();
        s.cells += tree.cells.size();
        s.half_spaces += tree.half_spaces;
        s.depth = std::max(s.depth, tree.depth);
        for (const BspCell& cell : tree.cells) {
            bool flat = cell.count > 0;
            for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
                local += pieces.half_spaces(i);
                flat &= pieces[i].kind == Piece::Kind::plane;
            }
            s.empty_cells += cell.count == 0;
            s.flat_cells += flat;
        }
    }
    if (s.cells > s.empty_cells) s.mean_local_half_spaces = double(local) / double(s.cells - s.empty_cells);
    return s;
}

}  // namespace deburr
