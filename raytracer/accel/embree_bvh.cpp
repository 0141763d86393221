// Why every box that the exact ray touches is found although Embree works in single precision. In a BoxFrame
// coordinates are at most 1 and distances to the planes of boxes at most 2; let u = 2⁻²⁴ be the unit roundoff. For a
// box side at B and a ray with origin o and direction d along its axis, Embree computes t = (B − o)·(1/d), or, for user
// geometry even in a robust scene, B·(1/d) − o·(1/d), fused or not. The error of the position along the axis is at most
//
//     ½u (B rounded) + ½u (o) + 2u (d, over a distance of 2) + 10u (1/d by an approximation and one step of
//     Newton's) + 4u (the products) + 2u (the difference)  <  20u  <  2⁻¹⁸ = 64u,
//
// and boxes are enlarged by 2⁻¹⁸. So, where a ray touches a box at s, each axis has t ≤ s at the near side and t ≥ s at
// the far one. That holds for rays parallel to an axis, too: Embree takes 10¹⁸ for 1/0, and the ray is at least 44u off
// either side, unless it touches neither box nor margin. The rest of the margin, 2⁻¹⁹, is more than the error in double
// precision of a ray that starts 2²⁸ sizes away.
#include "raytracer/accel/embree_bvh.hpp"

#include "raytracer/accel/bvh.hpp"
#include "raytracer/accel/embree.hpp"

namespace deburr {
namespace {

constexpr double bounds_rounding = 0x1p-18;

// The query of one ray, which the callbacks receive as Embree's context.
struct Query : EmbreeContext {
    const std::uint32_t* numbers;
    const BoxFrame* frame;
    double t0;
    double (*call)(void*, std::uint32_t);
    void* visit;

    void on_item(std::uint32_t item, RTCRay& ray) const {
        const double until = call(visit, numbers[item]);
        if (until < 0)
            ray.tfar = -std::numeric_limits<float>::infinity();
        else if (until < infinity)
            ray.tfar = std::min(ray.tfar, frame->distance(until - t0));
    }
};

// Embree calls these with packets of rays; the queries here have a single ray each.
void on_intersect(const RTCIntersectFunctionNArguments* a) {
    static_cast<const Query*>(static_cast<EmbreeContext*>(a->context))
        ->on_item(a->primID, reinterpret_cast<RTCRayHit*>(a->rayhit)->ray);
}

void on_occluded(const RTCOccludedFunctionNArguments* a) {
    static_cast<const Query*>(static_cast<EmbreeContext*>(a->context))
        ->on_item(a->primID, *reinterpret_cast<RTCRay*>(a->ray));
}

}  // namespace

struct EmbreeBvh::Embree {
    EmbreeScene scene;
    BoxFrame frame;
    std::vector<std::uint32_t> numbers;

    explicit Embree(const std::vector<NumberedBox>& boxes) {
        Box around;
        for (const NumberedBox& b : boxes) around = hull(around, b.box);
        frame = BoxFrame(around);
        numbers.reserve(boxes.size());
        for (const NumberedBox& b : boxes) numbers.push_back(b.number);
        RTCGeometry geometry = scene.new_geometry(RTC_GEOMETRY_TYPE_USER);
        embree().set_primitive_count(geometry, unsigned(boxes.size()));
        const std::pair<const BoxFrame*, const NumberedBox*> from{&frame, boxes.data()};
        embree().set_bounds_function(
            geometry,
            [](const RTCBoundsFunctionArguments* a) {
                const auto& [of_all, numbered] =
                    *static_cast<const std::pair<const BoxFrame*, const NumberedBox*>*>(a->geometryUserPtr);
                const Box& box = numbered[a->primID].box;
                const Vec3 lo = of_all->to_local(box.lo) - bounds_rounding,
                           hi = of_all->to_local(box.hi) + bounds_rounding;
                *a->bounds_o = {float(lo.x), float(lo.y), float(lo.z), 0, float(hi.x), float(hi.y), float(hi.z), 0};
            },
            nullptr);
        embree().set_user_data(geometry, const_cast<void*>(static_cast<const void*>(&from)));
        embree().set_intersect_function(geometry, on_intersect);
        embree().set_occluded_function(geometry, on_occluded);
        scene.add(geometry);
        scene.commit("the cells");
    }
};

EmbreeBvh::EmbreeBvh(const std::vector<NumberedBox>& boxes) : embree_(std::make_unique<Embree>(boxes)) {}
EmbreeBvh::EmbreeBvh(EmbreeBvh&&) noexcept = default;
EmbreeBvh& EmbreeBvh::operator=(EmbreeBvh&&) noexcept = default;
EmbreeBvh::~EmbreeBvh() = default;

void EmbreeBvh::run(const Vec3& origin, const Vec3& direction, double t0, double t1, Order order, Call call,
                    void* visit) const {
    const Embree& e = *embree_;
    Query query;
    query.numbers = e.numbers.data();
    query.frame = &e.frame;
    query.t0 = t0;
    query.call = call;
    query.visit = visit;
    const Vec3 start = e.frame.to_local(origin + direction * t0);
    RTCRayHit rayhit;
    RTCRay& ray = rayhit.ray;
    ray.org_x = float(start.x);
    ray.org_y = float(start.y);
    ray.org_z = float(start.z);
    ray.tnear = 0;
    ray.dir_x = float(direction.x);
    ray.dir_y = float(direction.y);
    ray.dir_z = float(direction.z);
    ray.time = 0;
    ray.tfar = e.frame.distance(t1 - t0);
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    if (order == Order::any) return e.scene.occluded(ray, query);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    e.scene.intersect(rayhit, query);
}

}  // namespace deburr
