#include "raytracer/spaces.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <map>
#include <unordered_map>

#include "bounds/bounding_box.hpp"
#include "raytracer/solid_forms.hpp"

namespace deburr {
namespace {

// Spaces within spaces; what is deeper is taken as it is.
constexpr int deepest_space = 8;
// A map that squeezes more would magnify what floating point rounds by.
constexpr double largest_condition = 64;
// A form further from its origin, in its own sizes, is moved there.
constexpr double farthest = 16;

double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

double norm(const Mat3& m) { return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])); }

Affine inverse(const Affine& map) {
    const Mat3 linear = glm::inverse(map.linear);
    return {linear, -(linear * map.shift)};
}

Box image(const Affine& map, const Box& box) {
    Box to{map.shift, map.shift};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double a = map.linear[i][k] * box.lo[i], b = map.linear[i][k] * box.hi[i];
            to.lo[k] += std::min(a, b);
            to.hi[k] += std::max(a, b);
        }
    const double slack = 16 * epsilon * std::max({largest(to.lo), largest(to.hi), largest(map.shift)});
    return inflated(to, slack);
}

struct Part {
    PlacedForm placed;
    int solid;
    Box box;
};

class Plan {
public:
    explicit Plan(const std::vector<Solid>& solids) {
        spaces.emplace_back();
        in_bsp.emplace_back();
        fill(0, solids, 0);
    }

    std::vector<Space> spaces;
    std::vector<std::vector<Solid>> in_bsp;  // of each space

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
        if (count.at(root.form) > 1) all.push_back(root);
        else all = operands(root, count);
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
        const BoxHierarchy hierarchy(boxes);
        for (std::size_t i = 0; i < all.size(); ++i)
            hierarchy.meeting(inflated(boxes[i], clear), [&](int j) {
                const int a = find(int(i)), b = find(j);
                group[std::size_t(std::max(a, b))] = std::min(a, b);
            });
        std::map<int, std::vector<std::size_t>> together;
        for (std::size_t i = 0; i < all.size(); ++i) together[find(int(i))].push_back(i);
        for (const auto& [first, members] : together) {
            Part part{all[members[0]], solid, {}};
            for (const std::size_t i : members) part.box = hull(part.box, boxes[i]);
            if (members.size() == all.size()) part.placed = root;
            else if (members.size() > 1) part.placed = forms_.of(sum(all, members));
            parts.push_back(part);
        }
    }

    const Solid& sum(const std::vector<PlacedForm>& all, const std::vector<std::size_t>& members) {
        Solid to = solid_of(all[members[0]]);
        for (std::size_t k = 1; k < members.size(); ++k) to = to | solid_of(all[members[k]]);
        sums_.push_back(to);  // forms look at it later
        return sums_.back();
    }

    void put(int space, const Solid& solid, int number) {
        // Below the world, materials that are not named stay so.
        in_bsp[std::size_t(space)].push_back(space == 0 ? solid : solid.material(-1));
        spaces[std::size_t(space)].solids.push_back(number);
    }

    void fill(int space, const std::vector<Solid>& solids, int depth) {
        if (depth == deepest_space) {
            for (std::size_t i = 0; i < solids.size(); ++i) put(space, solids[i], int(i));
            return;
        }
        std::vector<PlacedForm> roots;
        for (const Solid& s : solids) roots.push_back(forms_.of(s));
        const std::map<int, double> count = occurrences(roots);
        std::vector<Part> parts;
        for (std::size_t i = 0; i < roots.size(); ++i) take_apart(roots[i], int(i), count, parts);
        std::vector<Box> boxes;
        for (const Part& part : parts) {
            const Mat3& linear = part.placed.map.linear;
            if (parts.size() == 1 || !part.box.finite() || !(norm(linear) * norm(glm::inverse(linear)) < largest_condition)) {
                put(space, solid_of(part.placed), part.solid);
                continue;
            }
            place(space, part, depth);
            boxes.push_back(part.box);
        }
        spaces[std::size_t(space)].hierarchy = BoxHierarchy(boxes);
    }

    void place(int space, const Part& part, int depth) {
        const int form = part.placed.form;
        const Box own = box(form);
        const Vec3 sides = own.hi - own.lo;
        Affine centred;  // of the placed space in the form's
        if (std::max(largest(own.lo), largest(own.hi)) > farthest * largest(sides)) centred.shift = 0.5 * (own.lo + own.hi);
        auto [at, fresh] = space_of_.try_emplace(form, int(spaces.size()));
        const int number = at->second;
        if (fresh) {
            spaces.emplace_back();
            in_bsp.emplace_back();
            spaces.back().box = {own.lo - centred.shift, own.hi - centred.shift};
            const Solid solid = forms_.solid(form);
            fill(number, {centred.shift == Vec3(0.0) ? solid : solid.transformed({Mat3(1.0), -centred.shift})}, depth + 1);
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

std::vector<Space> build_spaces(const std::vector<Solid>& solids, Criterion criterion, Search search) {
    Plan plan(solids);
    std::vector<std::exception_ptr> errors(plan.spaces.size());
    tbb::parallel_for(std::size_t(0), plan.spaces.size(), [&](std::size_t i) {
        try {
            plan.spaces[i].bsp = BspTracer(build_bsp(plan.in_bsp[i], search), criterion);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);  // the first, whichever thread was quicker
    return std::move(plan.spaces);
}

}  // namespace deburr
