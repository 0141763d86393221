// Growth of the cost of a ray with the number of objects, and with the half-spaces of one object.
#include <fmt/format.h>
#include <malloc.h>

#include "bench/blocks.hpp"
#include "bench/picture.hpp"
#include "bench/sections.hpp"
#include "raytracer/trace/bsp_store.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr::bench {
namespace {

constexpr int rays = 40'000;
// Seconds. A scene whose tracer would take longer to build is left out, with a note.
constexpr double longest_build = 60;

double fraction(double x) { return x - std::floor(x); }

// A unit plate with k × k square pits, with 6 + 5 k² half-spaces in the papers' arithmetic, as the clip of all pits
// counts as one more. All sizes are proportional to a pit, the radius too.
Solid plate(int k) {
    const double pitch = 1.0 / k;
    Density pits = Density::box(Vec3(0.0), Vec3(1.0));
    for (int i = 0; i < k * k; ++i) {
        const Vec3 corner(pitch * (i % k), -0.5 * pitch, pitch * (i / k));
        const Density pit = Density::product({Density::half_space({-1, 0, 0}, -(corner.x + 0.25 * pitch)),
                                              Density::half_space({1, 0, 0}, corner.x + 0.75 * pitch),
                                              Density::half_space({0, -1, 0}, -corner.y),
                                              Density::half_space({0, 0, -1}, -(corner.z + 0.25 * pitch)),
                                              Density::half_space({0, 0, 1}, corner.z + 0.75 * pitch)});
        pits = i == 0 ? pit : pits + pit;
    }
    const Density top = Density::half_space({0, 1, 0}, 0);
    return Solid::rounded(0.05 * pitch, Density::box({0, -1, 0}, {1, 0, 1}) - top * pits);
}

// Rays to the middles of the pits' floors and of the rims' crossings, steeply from above.
std::vector<Ray> rays_to_flat_parts(int k) {
    const double pitch = 1.0 / k;
    std::vector<Ray> all;
    for (int n = 1; n <= rays; ++n) {
        const double i = std::floor(k * fraction(0.8192 * n)), j = std::floor(k * fraction(0.5497 * n));
        const double shift = n % 2 ? 0.5 : 0.125;  // floor or rim
        const Vec3 target((i + shift) * pitch, n % 2 ? -0.5 * pitch : 0, (j + shift) * pitch);
        const Vec3 eye(target + Vec3(0.1 * fraction(0.618 * n) - 0.05, 2, 0.1 * fraction(0.7549 * n) - 0.05));
        all.push_back({eye, glm::normalize(target - eye)});
    }
    return all;
}

double seconds_a_ray(const RayTracer& tracer, const std::vector<Ray>& all) {
    TraceCounters counters;
    return seconds_of(
               [&] {
                   for (const Ray& ray : all) keep(tracer.closest_hit(ray, infinity, counters));
               },
               5) /
           double(all.size());
}

// The growth of a cost: the last one over the one at x = reference_x.
struct Growth {
    double reference_x = 0, reference = 0, last_x = 0, last = 0;

    void add(double x, double seconds) {
        if (x == reference_x) reference = seconds;
        last_x = x;
        last = seconds;
    }
};

// A plate with k × k holes of 12 sides as one Boolean density.
Solid holed_plate(int k, double radius = 0.03) {
    Density plate = Density::box({0, 0, 0}, {double(k), 0.3, double(k)});
    for (int i = 0; i < k * k; ++i) {
        const Vec3 middle(i % k + 0.5, 0, i / k + 0.5);
        Density hole = Density::half_space({0, 1, 0}, 2) & Density::half_space({0, -1, 0}, 1);
        for (int j = 0; j < 12; ++j) {
            const double a = 2 * pi * (j + 0.5) / 12;
            const Vec3 n(std::cos(a), 0, std::sin(a));
            hole = hole & Density::half_space(n, glm::dot(n, middle) + 0.29);
        }
        plate = plate & ~hole;
    }
    return Solid::rounded(radius, plate);
}

// A convex body of n half-spaces around a ball, evenly distributed.
Solid ball(int n) {
    const auto half_space = [n](int i) {
        const double z = 1 - (2 * i + 1.0) / n, a = i * pi * (3 - std::sqrt(5.0));
        const double s = std::sqrt(1 - z * z);
        return Density::half_space({s * std::cos(a), s * std::sin(a), z}, 1);
    };
    Density all = half_space(0);
    for (int i = 1; i < n; ++i) all = all & half_space(i);
    return Solid::rounded(0.02, all);
}

double bytes_in_use() {
    const auto m = mallinfo2();
    return double(m.uordblks) + double(m.hblkhd);
}

// Measures rays through 10 to 100,000 placements of blocks.
void growth_with_objects(Report& report) {
    Growth objects{100};
    double build_a_block = 0;
    for (const int count : {10, 100, 1'000, 10'000, 100'000}) {
        if (build_a_block * count > longest_build) {
            report.note(fmt::format("{} blocks: left out, building would take {:.0f} s", count, build_a_block * count));
            continue;
        }
        const std::vector<Solid> solids = blocks(count);
        std::optional<ImplicitTracer> tracer;
        const double build = cpu_seconds_of([&] { tracer.emplace(solids); });
        build_a_block = build / count;
        const double ray = seconds_a_ray(*tracer, rays_through(std::cbrt(count), rays));
        objects.add(count, ray);
        report.figure(fmt::format("{} blocks: a ray", count), 1e6 * ray, "µs");
        report.figure(fmt::format("{} blocks: build", count), build, "s");
        report.point("rays through blocks", "objects", "µs per ray", count, 1e6 * ray);
    }
    report.ratio(fmt::format("a ray through {:.0f} blocks / 100 blocks", objects.last_x),
                 {objects.last, objects.reference}, at_most(3));
}

// Measures the time and the memory that building 1,000 to 100,000 blocks of different sizes takes.
void growth_with_different_objects(Report& report) {
    Growth forms{10'000};
    for (const int count : {1'000, 10'000, 100'000}) {
        const std::vector<Solid> solids = different_blocks(count);
        const double before = bytes_in_use();
        std::optional<ImplicitTracer> tracer;
        const double build = cpu_seconds_of([&] { tracer.emplace(solids); });
        const double bytes = bytes_in_use() - before;
        forms.add(count, build / count);
        const bool many = count == 100'000;
        report.figure(fmt::format("{} different blocks: build", count), build, "s",
                      many ? std::optional(at_most(1)) : std::nullopt);
        report.figure(fmt::format("{} different blocks: memory", count), 1e-6 * bytes, "MB",
                      many ? std::optional(at_most(150)) : std::nullopt);
        report.figure(fmt::format("{} different blocks: memory of a block", count), bytes / count, "bytes");
    }
    report.figure("a ray under way and its hit: memory", double(sizeof(Ray) + sizeof(Hit)), "bytes");
    report.ratio(fmt::format("to build one of {:.0f} different blocks / of 10,000", forms.last_x),
                 {forms.last, forms.reference}, at_most(3));
}

// Measures the building of one object's tracer, which should take at most `longest` seconds, and its memory.
void build_of_object(Report& report, const std::string& what, const Solid& object, double longest) {
    const std::vector<Solid> solids = {object};
    report.figure(what + ": build", seconds_of([&] { ImplicitTracer tracer(solids); }, 3), "s", at_most(longest));
    const double before = bytes_in_use();
    const ImplicitTracer tracer(solids);
    report.figure(what + ": memory of a cell", (bytes_in_use() - before) / double(tracer.statistics().cells), "bytes");
}

// Measures what building again costs after an edit of one object among 20, as the others' trees are kept.
void build_after_edit(Report& report) {
    const auto plates = [](int edited) {
        std::vector<Solid> all;
        for (int i = 0; i < 20; ++i)
            all.push_back(
                holed_plate(i == edited ? 7 : 8, 0.02 + 0.001 * i).transformed({Mat3(1.0), Vec3(0, 0, 10.0 * i)}));
        return all;
    };
    BspStore store;
    const std::vector<Solid> before_edit = plates(-1), after_edit = plates(4);
    const auto build_with_store = [&store](const std::vector<Solid>& solids) {
        return cpu_seconds_of(
            [&] { ImplicitTracer(solids, Criterion::exact, RootMethod::where_needed, Accel::bvh, &store); });
    };
    const double first = build_with_store(before_edit), again = build_with_store(after_edit);
    report.ratio("20 plates of 64 holes, one of them edited: to build again / to build", {again, first}, at_most(0.25));
}

// Measures the building of a million placements of one block.
void build_of_placements(Report& report) {
    const Solid block = Solid::rounded(0.05, Density::box(Vec3(0.0), Vec3(0.7)));
    std::vector<Solid> placed;
    for (int i = 0; i < 1'000'000; ++i) placed.push_back(block.transformed({Mat3(1.0), Vec3(i % 1000, 0, i / 1000)}));
    report.figure("1,000,000 placements: build", cpu_seconds_of([&] { ImplicitTracer tracer(placed); }), "s",
                  at_most(1));
}

// Measures rays to flat parts of one object of 12 to 6,132 half-spaces.
void growth_with_half_spaces(Report& report) {
    Growth half_spaces{12};
    for (const int k : {1, 4, 11, 35}) {
        const int count = 7 + 5 * k * k;
        const ImplicitTracer tracer({plate(k)});
        const double ray = seconds_a_ray(tracer, rays_to_flat_parts(k));
        half_spaces.add(count, ray);
        report.figure(fmt::format("one object of {} half-spaces: a ray to a flat part", count), 1e6 * ray, "µs");
        report.point("rays to one object", "half-spaces", "µs per ray", count, 1e6 * ray);
    }
    report.ratio(fmt::format("a ray to {:.0f} half-spaces / 12", half_spaces.last_x),
                 {half_spaces.last, half_spaces.reference}, at_most(3));
}

}  // namespace

void growth_of_tracing(Report& report) {
    growth_with_objects(report);
    growth_with_different_objects(report);
    build_of_object(report, "a plate of 1,024 holes of 12 sides", holed_plate(32), 0.4);
    build_of_object(report, "an object of 2,000 half-spaces", ball(2000), 0.3);
    build_after_edit(report);
    build_of_placements(report);
    growth_with_half_spaces(report);
}

}  // namespace deburr::bench
