#include "raytracer/trace/instances.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "bounds/bounding_box.hpp"
#include "bounds/canonical_solids.hpp"
#include "raytracer/util/in_parallel.hpp"

namespace deburr {
namespace {

// Spaces within spaces; what is deeper is taken as it is.
constexpr int deepest_space = 8;
// A map that squeezes more would magnify what floating point rounds by.
constexpr double largest_condition = 64;
// A form further from its origin, in its own sizes, is moved there.
constexpr double farthest = 16;
// What is smaller than this, of the space that it is in, is found by a tree of boxes of its own, whose single
// precision is finer.
constexpr double least_size = 0x1p-10;
// Tolerances of a solid among larger ones are at least these ones' times this: cells must know their solids
// further beyond their walls, by 2⁻³⁸, than a ray's place is off by, of the larger scale and a few times 2⁻⁵⁰.
constexpr double least_share_of_scale = 0x1p-8;

double norm(const Mat3& m) { return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])); }

struct Part {
    PlacedForm placed;
    int solid;
    Box box;
};

bool is_turned(const Mat3& m) {
    return m[0][1] != 0 || m[0][2] != 0 || m[1][0] != 0 || m[1][2] != 0 || m[2][0] != 0 || m[2][1] != 0;
}

// What is in one BSP.
struct Group {
    std::vector<Solid> solids;
    std::vector<int> numbers;  // in the world
};

struct PlannedSpace {
    std::vector<Group> groups{1};  // the first is of what is unbounded, or squeezed, or all there is
    double reach = 0;              // of the others
    Placements placements;
    std::vector<Box> boxes;  // of the placements
};

class Plan {
public:
    explicit Plan(const std::vector<Solid>& solids) {
        spaces.emplace_back();
        fill(0, solids, 0);
    }

    std::vector<PlannedSpace> spaces;

private:
    bool is_union(int form) const { return forms_.solid(form).node().kind == SolidNode::Kind::unite; }

    PlacedForm within(const PlacedForm& outer, const Solid& child) {
        PlacedForm to = forms_.of(child);
        to.map = compose(outer.map, to.map);
        if (to.material < 0) to.material = outer.material;
        return to;
    }

    /// How often each form occurs, counting through unions.
    std::map<int, double> occurrences(const std::vector<PlacedForm>& roots) {
        std::map<int, double> count;
        std::map<int, double, std::greater<int>> open;  // parts have lower numbers
        for (const PlacedForm& root : roots) open[root.form] += 1;
        while (!open.empty()) {
            const auto [form, times] = *open.begin();
            open.erase(open.begin());
            count[form] = times;
            if (!is_union(form)) continue;
            const Solid solid = forms_.solid(form);
            for (const Solid& child : solid.node().children) open[forms_.of(child).form] += times;
        }
        return count;
    }

    /// In the form's own space.
    const Box& box(int form) {
        const auto [at, fresh] = boxes_.try_emplace(form);
        if (fresh) at->second = bounding_box(flatten(forms_.solid(form)));
        return at->second;
    }

    /// The operands of a union, as far down as unions occur once.
    std::vector<PlacedForm> operands(const PlacedForm& root, const std::map<int, double>& count) {
        std::vector<PlacedForm> open{root}, all;
        while (!open.empty()) {
            const PlacedForm now = open.back();
            open.pop_back();
            if (!is_union(now.form) || (count.at(now.form) > 1 && now.form != root.form)) {
                all.push_back(now);
                continue;
            }
            const Solid solid = forms_.solid(now.form);
            const auto& children = solid.node().children;
            for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back(within(now, *child));
        }
        return all;
    }

    Solid solid_of(const PlacedForm& placed) const {
        const Solid solid = forms_.solid(placed.form).transformed(placed.map);
        return placed.material < 0 ? solid : solid.material(placed.material);
    }

    /// Takes a union that occurs once apart; operands that meet stay together.
    void take_apart(const PlacedForm& root, int solid, const std::map<int, double>& count, std::vector<Part>& parts) {
        std::vector<PlacedForm> all;
        if (count.at(root.form) > 1)
            all.push_back(root);
        else
            all = operands(root, count);
        std::erase_if(all, [&](const PlacedForm& p) { return box(p.form).empty(); });
        if (all.empty()) return;
        std::vector<Box> boxes;
        Box around;
        for (const PlacedForm& p : all) {
            boxes.push_back(box(p.form).finite() ? image(p.map, box(p.form)) : Box::everything());
            around = hull(around, boxes.back());
        }
        const bool bounded = std::all_of(boxes.begin(), boxes.end(), [](const Box& b) { return b.finite(); });
        if (all.size() == 1 || !bounded) {
            parts.push_back({root, solid, bounded ? boxes[0] : Box::everything()});
            return;
        }
        const double clear = std::max(largest(around.lo), largest(around.hi)) * 0x1p-30;  // more than any cell's margin
        std::vector<int> group(all.size());
        for (std::size_t i = 0; i < group.size(); ++i) group[i] = int(i);
        const auto find = [&](int i) {
            while (group[std::size_t(i)] != i) i = group[std::size_t(i)] = group[std::size_t(group[std::size_t(i)])];
            return i;
        };
        BoxTree::Builder builder;
        std::vector<int> items;
        for (std::size_t i = 0; i < all.size(); ++i) items.push_back(builder.item(std::uint32_t(i), boxes[i]));
        const BoxTree tree(builder, builder.join_by_area(std::move(items)));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Box near = inflated(boxes[i], clear);
            tree.meeting(near, [&](std::uint32_t j) {
                if (intersection(near, boxes[j]).empty()) return;
                const int a = find(int(i)), b = find(int(j));
                group[std::size_t(std::max(a, b))] = std::min(a, b);
            });
        }
        std::map<int, std::vector<std::size_t>> together;
        for (std::size_t i = 0; i < all.size(); ++i) together[find(int(i))].push_back(i);
        for (const auto& [first, members] : together) {
            Part part{all[members[0]], solid, {}};
            for (const std::size_t i : members) part.box = hull(part.box, boxes[i]);
            if (members.size() == all.size())
                part.placed = root;
            else if (members.size() > 1)
                part.placed = forms_.of(sum(all, members));
            parts.push_back(part);
        }
    }

    const Solid& sum(const std::vector<PlacedForm>& all, const std::vector<std::size_t>& members) {
        Solid to = solid_of(all[members[0]]);
        for (std::size_t k = 1; k < members.size(); ++k) to = to | solid_of(all[members[k]]);
        sums_.push_back(to);  // forms look at it later
        return sums_.back();
    }

    void put(int space, Group& group, const Solid& solid, int number) {
        // Below the world, materials that are not named stay so.
        group.solids.push_back(space == 0 ? solid : solid.material(-1));
        group.numbers.push_back(number);
    }

    void fill(int space, const std::vector<Solid>& solids, int depth) {
        if (depth == deepest_space) {
            for (std::size_t i = 0; i < solids.size(); ++i)
                put(space, spaces[std::size_t(space)].groups[0], solids[i], int(i));
            return;
        }
        std::vector<PlacedForm> roots;
        for (const Solid& s : solids) roots.push_back(forms_.of(s));
        const std::map<int, double> count = occurrences(roots);
        std::vector<Part> parts;
        for (std::size_t i = 0; i < roots.size(); ++i) take_apart(roots[i], int(i), count, parts);
        std::map<int, int> uses;
        Box around;
        for (const Part& part : parts) {
            ++uses[part.placed.form];
            if (part.box.finite()) around = hull(around, part.box);
        }
        const double whole = largest(around.hi - around.lo);
        for (const Part& part : parts) {
            const Mat3& linear = part.placed.map.linear;
            PlannedSpace& here = spaces[std::size_t(space)];
            if (parts.size() == 1 || !part.box.finite() ||
                !(norm(linear) * norm(glm::inverse(linear)) < largest_condition)) {
                put(space, here.groups[0], solid_of(part.placed), part.solid);
                continue;
            }
            const double size = largest(part.box.hi - part.box.lo),
                         reach = std::max(largest(part.box.lo), largest(part.box.hi));
            const bool fits = reach <= farthest * size && size >= least_size * whole;
            if (fits && uses.at(part.placed.form) == 1 && !is_turned(linear) && !space_of_.count(part.placed.form)) {
                put(space, here.groups.emplace_back(), solid_of(part.placed), part.solid);
                here.reach = std::max(here.reach, reach);
                continue;
            }
            place(space, part, depth);
            spaces[std::size_t(space)].boxes.push_back(part.box);
        }
    }

    void place(int space, const Part& part, int depth) {
        const int form = part.placed.form;
        const Box own = box(form);
        const Vec3 sides = own.hi - own.lo;
        Affine centred;  // of the placed space in the form's
        if (std::max(largest(own.lo), largest(own.hi)) > farthest * largest(sides))
            centred.shift = 0.5 * (own.lo + own.hi);
        auto [at, fresh] = space_of_.try_emplace(form, int(spaces.size()));
        const int number = at->second;
        if (fresh) {
            spaces.emplace_back();
            const Solid solid = forms_.solid(form);
            fill(number, {centred.shift == Vec3(0.0) ? solid : solid.transformed({Mat3(1.0), -centred.shift})},
                 depth + 1);
        }
        const Affine map = compose(part.placed.map, centred);
        const Affine into = inverse(map);
        spaces[std::size_t(space)].placements.push_back(
            {into, norm(map.linear), number, part.solid, part.placed.material, into.linear == Mat3(1.0)});
    }

    SolidForms forms_;
    std::vector<Solid> sums_;
    std::unordered_map<int, Box> boxes_;
    std::unordered_map<int, int> space_of_;
};

}  // namespace

std::vector<Space> build_spaces(const std::vector<Solid>& solids, Criterion criterion, Search search, Accel accel) {
    Plan plan(solids);
    std::vector<Space> spaces(plan.spaces.size());
    in_parallel(spaces.size(), [&](std::size_t i) {
        PlannedSpace& planned = plan.spaces[i];
        std::vector<NamedBsp> bsps(planned.groups.size());
        const auto build = [&](std::size_t k, double least_scale) {
            bsps[k] = {build_bsp(planned.groups[k].solids, search, least_scale), std::move(planned.groups[k].numbers)};
        };
        build(0, 0);
        const double scale = std::max(bsps[0].tree.tolerances.scale, planned.reach);
        in_parallel(bsps.size() - 1, [&](std::size_t k) { build(k + 1, least_share_of_scale * scale); });
        spaces[i] = {BspTracer(std::move(bsps), planned.boxes, criterion, accel), std::move(planned.placements)};
        spaces[i].bsp.others_lie_at(spaces[i].placements.data(), sizeof(Placement));
    });
    return spaces;
}

}  // namespace deburr
