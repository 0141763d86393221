#include <algorithm>

#include "raytracer/trace/implicit_tracer.hpp"
#include "raytracer/trace/instances.hpp"

namespace deburr {

namespace {

// What is placed in a space. It sees the ray with a unit direction of its own, so that tolerances mean
// there what they mean here; distances along it are longer by `rate`.
class Placed final : public Others {
public:
    Placed(const Spaces& all, const Space& space) : all_(all), space_(space) {}

    FoundSurface find(std::uint32_t number, const Ray& ray, double t_max, double end,
                      TraceCounters& counters) const override;
    bool any(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const override;
    void find_together(std::uint32_t number, const SeveralRays& rays, FoundSurface* found,
                       TraceCounters& counters) const override;
    Lanes any_together(std::uint32_t number, const SeveralRays& rays, TraceCounters& counters) const override;

private:
    struct Entered;

    const Spaces& all_;
    const Space& space_;
};

// A placement that rays enter.
struct Placed::Entered {
    Entered(const Placed& around, std::uint32_t number, std::size_t rays, TraceCounters& counters)
        : p(around.space_.placements[number]),
          space(around.all_[std::size_t(p.space)]),
          bsp(space.bsp),
          others(around.all_, space) {
        counters.placements += rays;
    }

    const Placement& p;
    const Space& space;
    const BspTracer& bsp;
    Placed others;
};

// What a ray is in the placed space.
struct Inside {
    Inside(const Placement& p, const Ray& from) {
        if (p.only_moved) {
            ray = {from.origin + p.into.shift, from.direction};
            return;
        }
        const Vec3 direction = p.into.linear * from.direction;
        rate = glm::length(direction);
        ray = {p.into(from.origin), direction / rate};
    }
    // A distance is rounded there and back: what is at `end` must be found.
    double end(double outside) const { return outside * rate * (1 + 4 * epsilon); }

    Ray ray;
    double rate = 1;
};

// What several are.
struct InsideTogether {
    InsideTogether(const Placement& p, const SeveralRays& from) : count(from.size()) {
        for (std::size_t k = 0; k < count; ++k) {
            const Inside in(p, from.rays[k]);
            rays[k] = in.ray;
            rates[k] = in.rate;
            t_max[k] = from.t_max[k] * in.rate;
            ends[k] = in.end(from.end[k]);
        }
    }
    SeveralRays several() const { return {{rays, count}, {t_max, count}, {ends, count}}; }

    std::size_t count;
    Ray rays[RayPacket::size];
    double rates[RayPacket::size], t_max[RayPacket::size], ends[RayPacket::size];
};

// What was found along `ray`, in the space around again.
FoundSurface outside(FoundSurface found, const Placement& p, const Ray& ray, double rate) {
    if (!(found.crossing.t < infinity)) return {};
    found.crossing.t = (found.start + found.crossing.t) / rate;
    found.start = 0;
    if (!p.only_moved)
        found.crossing.normal = glm::normalize(found.crossing.normal * p.into.linear);  // by the transpose
    if (found.crossing.material < 0) found.crossing.material = p.material;
    found.solid = p.solid;
    found.error = found.error * p.stretch + 4 * epsilon * (largest(ray.origin) + found.crossing.t);
    return found;
}

FoundSurface Placed::find(std::uint32_t number, const Ray& ray, double t_max, double end,
                          TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    return outside(e.bsp.find(in.ray, t_max * in.rate, counters, &e.others, in.end(end)), e.p, ray, in.rate);
}

bool Placed::any(std::uint32_t number, const Ray& ray, double t_max, TraceCounters& counters) const {
    const Entered e(*this, number, 1, counters);
    const Inside in(e.p, ray);
    return e.bsp.any(in.ray, t_max * in.rate, counters, &e.others);
}

void Placed::find_together(std::uint32_t number, const SeveralRays& rays, FoundSurface* found,
                           TraceCounters& counters) const {
    const Entered e(*this, number, rays.size(), counters);
    const InsideTogether in(e.p, rays);
    e.bsp.find(in.several(), found, counters, &e.others);
    for (std::size_t k = 0; k < rays.size(); ++k) found[k] = outside(found[k], e.p, rays.rays[k], in.rates[k]);
}

Lanes Placed::any_together(std::uint32_t number, const SeveralRays& rays, TraceCounters& counters) const {
    const Entered e(*this, number, rays.size(), counters);
    return e.bsp.any(InsideTogether(e.p, rays).several(), counters, &e.others);
}

}  // namespace

ImplicitTracer::ImplicitTracer(const std::vector<Solid>& solids, Criterion criterion, Search search, Accel accel)
    : spaces_(new Spaces(solids, criterion, search, accel)) {}

ImplicitTracer::~ImplicitTracer() = default;

namespace {

Hit hit_of(const FoundSurface& found, const Ray& ray) {
    if (!(found.crossing.t < infinity)) return {};
    Hit hit;
    hit.t = found.crossing.t;
    hit.position = ray.origin + ray.direction * hit.t;
    if (found.start > 0) [[unlikely]] {
        hit.t += found.start;
        // Summed up as the search did: on the surface, wherever the ray comes from.
        hit.position = (ray.origin + ray.direction * found.start) + ray.direction * found.crossing.t;
    }
    hit.normal = found.crossing.normal;
    hit.solid = found.solid;
    hit.material = std::max(0, found.crossing.material);
    // Far beyond the error of the position, far below anything to be seen.
    hit.offset = 128 * found.error;
    return hit;
}

}  // namespace

Hit ImplicitTracer::first_hit(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.rays;
    const Placed placed(*spaces_, (*spaces_)[0]);
    return hit_of((*spaces_)[0].bsp.find(ray, t_max, counters, &placed), ray);
}

bool ImplicitTracer::occluded(const Ray& ray, double t_max, TraceCounters& counters) const {
    ++counters.shadow_rays;
    const Placed placed(*spaces_, (*spaces_)[0]);
    return (*spaces_)[0].bsp.any(ray, t_max, counters, &placed);
}

void ImplicitTracer::first_hits(std::span<const Ray> rays, Hit* hits, TraceCounters& counters) const {
    static const std::vector<double> endless(RayPacket::size, infinity);
    counters.rays += rays.size();
    const Placed placed(*spaces_, (*spaces_)[0]);
    FoundSurface found[RayPacket::size];
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const auto packet = rays.subspan(first, std::min(rays.size() - first, std::size_t(RayPacket::size)));
        (*spaces_)[0].bsp.find({packet, endless, endless}, found, counters, &placed);
        for (std::size_t k = 0; k < packet.size(); ++k) hits[first + k] = hit_of(found[k], packet[k]);
    }
}

void ImplicitTracer::occlusions(std::span<const Ray> rays, std::span<const double> t_max, bool* occluded,
                                TraceCounters& counters) const {
    counters.shadow_rays += rays.size();
    const Placed placed(*spaces_, (*spaces_)[0]);
    for (std::size_t first = 0; first < rays.size(); first += RayPacket::size) {
        const std::size_t count = std::min(rays.size() - first, std::size_t(RayPacket::size));
        const auto ends = t_max.subspan(first, count);
        const Lanes any = (*spaces_)[0].bsp.any({rays.subspan(first, count), ends, ends}, counters, &placed);
        for (std::size_t k = 0; k < count; ++k) occluded[first + k] = any >> k & 1;
    }
}

BspStatistics ImplicitTracer::statistics() const {
    BspStatistics s;
    std::size_t local = 0;
    for (std::size_t i = 0; i < spaces_->size(); ++i) {
        if (!spaces_->built(i)) {
            ++s.spaces;
            continue;
        }
        const Space& space = *spaces_->built(i);
        const Pieces& pieces = space.bsp.surfaces().pieces;
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
