#include "raytracer/model/shell_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "raytracer/util/count_text.hpp"

namespace deburr {

using Corners = ClosedMesh::Corners;

namespace {

// Six times the volume enclosed by the triangles, negative if they face inward.
double six_volumes(const FileSurface& surface, const std::vector<Corners>& triangles) {
    double six = 0;
    const Vec3 o = surface.vertices[triangles[0][0]];
    for (const Corners& c : triangles)
        six += glm::dot(surface.vertices[c[0]] - o, glm::cross(surface.vertices[c[1]] - o, surface.vertices[c[2]] - o));
    return six;
}

// A shell as a solid of its own, used to find out which shells lie inside others.
struct Shell {
    std::vector<int> triangles;
    std::unique_ptr<ClosedMesh> mesh;  // faces outward; null if it is not closed alone
    int sign = 1;                      // −1: it faced inward in the file
};

std::vector<Shell> shells(const FileSurface& surface) {
    int count = 0;
    const std::vector<int> shell_of = shells_of(surface, count);
    std::vector<Shell> all;
    all.resize(std::size_t(count));
    for (std::size_t t = 0; t < shell_of.size(); ++t) all[shell_of[t]].triangles.push_back(int(t));
    for (Shell& shell : all) {
        std::vector<Corners> own;
        for (const int t : shell.triangles) own.push_back(surface.triangles[t]);
        shell.sign = six_volumes(surface, own) < 0 ? -1 : 1;
        if (shell.sign < 0)
            for (Corners& c : own) std::swap(c[1], c[2]);
        try {
            shell.mesh = std::make_unique<ClosedMesh>(surface.vertices, std::move(own));
        } catch (const NotClosed&) {  // it is connected to others by edges with four triangles
        }
    }
    return all;
}

bool holds(const Shell& outer, const Shell& inner) {
    if (!outer.mesh || !inner.mesh || outer.mesh->size() == 0 || inner.mesh->size() == 0) return false;
    const Box a = outer.mesh->bounding_box(), b = inner.mesh->bounding_box();
    for (int k = 0; k < 3; ++k)
        if (b.lo[k] < a.lo[k] || b.hi[k] > a.hi[k]) return false;
    // The shells do not cross but may touch in a point, so the middles of a few triangles decide by majority.
    int in = 0, asked = 0;
    const int step = std::max(1, int(inner.mesh->size()) / 5);
    for (int t = 0; t < int(inner.mesh->size()); t += step, ++asked)
        in += outer.mesh->contains((inner.mesh->corner(t, 0) + inner.mesh->corner(t, 1) + inner.mesh->corner(t, 2)) /
                                   3.0);
    return 2 * in > asked;
}

}  // namespace

void settle_shells(FileSurface& surface, bool trusted, const std::vector<std::pair<int, int>>& crossing,
                   std::vector<std::string>& mended) {
    std::vector<Shell> all = shells(surface);
    std::set<std::pair<int, int>> cross;
    if (!crossing.empty()) {
        int count = 0;
        const std::vector<int> shell = shells_of(surface, count);
        for (const auto& [a, b] : crossing) cross.insert(std::minmax(shell[a], shell[b]));
    }
    std::vector<char> meets(all.size(), false);  // crosses another shell; if it faces inward, it may be a hole in that
    for (const auto& [a, b] : cross)
        if (a != b) meets[a] = meets[b] = true;
    constexpr std::size_t most = 2'000;  // shells; all pairs are compared
    if (all.size() > most) return;
    std::size_t turned = 0, dropped = 0;
    if (trusted && six_volumes(surface, surface.triangles) < 0) {  // the whole surface is inside out
        for (Corners& c : surface.triangles) std::swap(c[1], c[2]);
        for (Shell& shell : all) shell.sign = -shell.sign;
        turned = surface.triangles.size();
    }
    std::vector<char> gone(surface.triangles.size(), false);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].mesh) continue;  // it belongs to a body that shares facets with another, and has no side of its own
        int outside = 0, depth = 0;
        for (std::size_t j = 0; j < all.size(); ++j)
            if (j != i && holds(all[j], all[i]) && !cross.contains(std::minmax(int(i), int(j)))) {
                ++depth;
                outside += all[j].sign;
            }
        const auto turn = [&] {
            turned += all[i].triangles.size();
            for (const int t : all[i].triangles) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
        };
        const int sign = all[i].sign;
        if (!trusted) {
            const int wanted = depth % 2 == 0 ? 1 : -1;
            if (all[i].sign != wanted) turn();
        } else if (outside <= 0 && sign < 0 && !meets[i]) {
            turn();
        } else if (crossing.empty() && (outside >= 1) == (outside + sign >= 1)) {
            ++dropped;
            for (const int t : all[i].triangles) gone[t] = true;
        }
    }
    if (turned > 0) mended.push_back(fmt::format("turned {} that faced inward", count_of(turned, "facet")));
    if (dropped == 0) return;
    mended.push_back(fmt::format("dropped {} within the solid", count_of(dropped, "shell")));
    std::vector<Corners> left;
    for (std::size_t t = 0; t < gone.size(); ++t)
        if (!gone[t]) left.push_back(surface.triangles[t]);
    surface.triangles = std::move(left);
}

}  // namespace deburr
