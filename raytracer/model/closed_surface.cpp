#include "raytracer/model/closed_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "bounds/sort_once.hpp"
#include "bounds/union_find.hpp"
#include "polygonizer/mesh/crossing_triangles.hpp"
#include "raytracer/model/flat_faces.hpp"
#include "raytracer/model/united_shells.hpp"

namespace deburr {
namespace {

using Corners = ClosedMesh::Corners;

struct Surface {
    std::vector<Vec3> vertices;
    std::vector<Corners> triangles;
};

std::string place(Vec3 x) { return fmt::format("{{{:.6g}, {:.6g}, {:.6g}}}", x.x, x.y, x.z); }

std::string count_of(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

double size_of(const std::vector<Vec3>& vertices) {
    Box box;
    for (const Vec3& v : vertices) box = hull(box, Box{v, v});
    return box.empty() ? 0 : largest(box.hi - box.lo);
}

// Numbers vertices anew: those for which `same` holds of neighbours in the order by coordinates are one.
Surface welded(const TriangleSoup& soup) {
    Surface to;
    std::vector<int> order(soup.vertices.size()), number(soup.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](int i) {
        const Vec3 v = soup.vertices[i] + 0.0;  // −0 is 0
        return std::tuple(v.x, v.y, v.z);
    };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    // In the order in which the file has them, so that equal files give equal meshes whatever their vertices' values.
    std::vector<int> first(soup.vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    for (std::size_t i = 0; i < first.size(); ++i)
        if (first[i] == int(i)) {
            number[i] = int(to.vertices.size());
            to.vertices.push_back(soup.vertices[i] + 0.0);
        }
    for (const auto& t : soup.triangles)
        to.triangles.push_back({number[first[t[0]]], number[first[t[1]]], number[first[t[2]]]});
    return to;
}

void drop_collapsed(Surface& surface) {
    std::erase_if(surface.triangles, [](const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

// Equal triangles count once, and a pair back to back not at all. Returns how many went.
std::size_t drop_doubles(Surface& surface) {
    struct Key {
        Corners sorted;
        bool even;  // orientation
        int at;
    };
    std::vector<Key> keys;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        Corners c = surface.triangles[t];
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        const bool even = c[1] < c[2];
        if (!even) std::swap(c[1], c[2]);
        keys.push_back({c, even, int(t)});
    }
    std::sort(keys.begin(), keys.end(),
              [](const Key& a, const Key& b) { return a.sorted != b.sorted ? a.sorted < b.sorted : a.at < b.at; });
    std::vector<char> gone(surface.triangles.size(), false);
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i;
        bool any[2] = {false, false};
        for (; end < keys.size() && keys[end].sorted == keys[i].sorted; ++end) any[keys[end].even] = true;
        for (std::size_t k = i; k < end; ++k) gone[keys[k].at] = (any[0] && any[1]) || k > i;
        i = end;
    }
    std::vector<Corners> left;
    for (std::size_t t = 0; t < gone.size(); ++t)
        if (!gone[t]) left.push_back(surface.triangles[t]);
    const std::size_t dropped = surface.triangles.size() - left.size();
    surface.triangles = std::move(left);
    return dropped;
}

struct HalfEdge {
    int lo, hi, triangle, k;
    bool up;
};

std::vector<HalfEdge> sorted_edges(const Surface& surface) {
    std::vector<HalfEdge> edges;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), int(t), k, a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.lo, a.hi, a.triangle, a.k) < std::tie(b.lo, b.hi, b.triangle, b.k);
    });
    return edges;
}

// Calls visit(first, last) for the half-edges of each edge.
template <class Visit>
void each_edge(const std::vector<HalfEdge>& edges, Visit visit) {
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].lo == edges[i].lo && edges[end].hi == edges[i].hi) ++end;
        visit(&edges[i], &edges[i] + (end - i));
        i = end;
    }
}

struct Openness {
    std::size_t open = 0;      // edges with an odd number of triangles
    std::size_t unturned = 0;  // even, but not as many one way as the other
    Vec3 place{0.0};
    std::vector<int> rim;  // vertices of open edges
};

Openness openness(const Surface& surface) {
    Openness o;
    each_edge(sorted_edges(surface), [&](const HalfEdge* first, const HalfEdge* last) {
        const auto count = last - first;
        if (count % 2 != 0) {
            if (o.open++ == 0) o.place = 0.5 * (surface.vertices[first->lo] + surface.vertices[first->hi]);
            o.rim.insert(o.rim.end(), {first->lo, first->hi});
        } else {
            o.unturned += std::count_if(first, last, [](const HalfEdge& e) { return e.up; }) * 2 != count;
        }
    });
    sort_once(o.rim);
    return o;
}

// Joins vertices of open edges that are within `distance` of one another.
void weld_rim(Surface& surface, const std::vector<int>& rim, double distance) {
    std::vector<int> order = rim;
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        return surface.vertices[a].x != surface.vertices[b].x ? surface.vertices[a].x < surface.vertices[b].x : a < b;
    });
    UnionFind same(surface.vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size(); ++k) {
            const Vec3 d = surface.vertices[order[k]] - surface.vertices[order[i]];
            if (d.x > distance) break;
            if (glm::dot(d, d) <= distance * distance)
                same.join(std::min(order[i], order[k]), std::max(order[i], order[k]));
        }
    for (Corners& t : surface.triangles)
        for (int& v : t) v = same.find(v);
    drop_collapsed(surface);
}

// Triangles that hang together, by the edges that two of them share.
std::vector<int> shells_of(const Surface& surface, int& count) {
    UnionFind joined(surface.triangles.size());
    each_edge(sorted_edges(surface), [&](const HalfEdge* first, const HalfEdge* last) {
        if (last - first == 2) joined.join(first[0].triangle, first[1].triangle);
    });
    std::vector<int> shell(surface.triangles.size()), number(surface.triangles.size(), -1);
    count = 0;
    for (std::size_t t = 0; t < shell.size(); ++t) {
        int& n = number[joined.find(int(t))];
        if (n < 0) n = count++;
        shell[t] = n;
    }
    return shell;
}

// Turns triangles so that neighbours agree; returns how many, or −1 where a shell has one side only.
long turn_alike(Surface& surface) {
    std::vector<std::array<int, 3>> neighbour(surface.triangles.size(), {-1, -1, -1});
    std::vector<std::array<char, 3>> agrees(surface.triangles.size(), {true, true, true});
    each_edge(sorted_edges(surface), [&](const HalfEdge* first, const HalfEdge* last) {
        if (last - first != 2) return;
        for (int i = 0; i < 2; ++i) {
            neighbour[first[i].triangle][first[i].k] = first[1 - i].triangle;
            agrees[first[i].triangle][first[i].k] = first[0].up != first[1].up;
        }
    });
    std::vector<signed char> turned(surface.triangles.size(), -1);
    std::vector<int> todo;
    long total = 0;
    for (std::size_t seed = 0; seed < turned.size(); ++seed) {
        if (turned[seed] >= 0) continue;
        turned[seed] = 0;
        todo.assign(1, int(seed));
        std::vector<int> all;
        while (!todo.empty()) {
            const int t = todo.back();
            todo.pop_back();
            all.push_back(t);
            for (int k = 0; k < 3; ++k) {
                const int next = neighbour[t][k];
                if (next < 0) continue;
                const auto wanted = static_cast<signed char>(agrees[t][k] ? turned[t] : 1 - turned[t]);
                if (turned[next] < 0) {
                    turned[next] = wanted;
                    todo.push_back(next);
                } else if (turned[next] != wanted) {
                    return -1;
                }
            }
        }
        // The lesser part is what is wrong.
        const auto flipped = std::count_if(all.begin(), all.end(), [&](int t) { return turned[t] == 1; });
        const bool other = 2 * flipped > long(all.size());
        for (const int t : all)
            if ((turned[t] == 1) != other) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
        total += other ? long(all.size()) - flipped : flipped;
    }
    return total;
}

Mesh as_mesh(const Surface& surface) {
    Mesh mesh;
    mesh.positions = surface.vertices;
    for (const Corners& t : surface.triangles) mesh.triangles.push_back({t, {0, 0, 0}});
    return mesh;
}

// Six times the volume that triangles enclose, less than 0 where they face inward.
double six_volumes(const Surface& surface, const std::vector<Corners>& triangles) {
    double six = 0;
    const Vec3 o = surface.vertices[triangles[0][0]];
    for (const Corners& c : triangles)
        six += glm::dot(surface.vertices[c[0]] - o, glm::cross(surface.vertices[c[1]] - o, surface.vertices[c[2]] - o));
    return six;
}

// Shells as solids of their own, to see which lies in which.
struct Shell {
    std::vector<int> triangles;
    std::unique_ptr<ClosedMesh> mesh;  // faces outward
    int sign = 1;                      // −1: faced inward
};

std::vector<Shell> shells(const Surface& surface) {
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
        } catch (const NotClosed&) {  // it hangs together with others at edges of four triangles
        }
    }
    return all;
}

bool holds(const Shell& outer, const Shell& inner) {
    if (!outer.mesh || !inner.mesh || outer.mesh->size() == 0 || inner.mesh->size() == 0) return false;
    const Box a = outer.mesh->bounding_box(), b = inner.mesh->bounding_box();
    for (int k = 0; k < 3; ++k)
        if (b.lo[k] < a.lo[k] || b.hi[k] > a.hi[k]) return false;
    // They do not cross, but may touch in a point: the middles of a few triangles decide.
    int in = 0, asked = 0;
    const int step = std::max(1, int(inner.mesh->size()) / 5);
    for (int t = 0; t < int(inner.mesh->size()); t += step, ++asked)
        in += outer.mesh->contains((inner.mesh->corner(t, 0) + inner.mesh->corner(t, 1) + inner.mesh->corner(t, 2)) /
                                   3.0);
    return 2 * in > asked;
}

// Turns shells so that the solid is where it must be; `trusted`: what the file says of the sides counts. Those that
// cross lie in each other no more than side by side, and stay.
void settle_shells(Surface& surface, bool trusted, const std::vector<std::pair<int, int>>& crossing,
                   std::vector<std::string>& mended) {
    std::vector<Shell> all = shells(surface);
    std::set<std::pair<int, int>> cross;
    if (!crossing.empty()) {
        int count = 0;
        const std::vector<int> shell = shells_of(surface, count);
        for (const auto& [a, b] : crossing) cross.insert(std::minmax(shell[a], shell[b]));
    }
    std::vector<char> meets(all.size(), false);  // another; one that faces inward may be a hole in that
    for (const auto& [a, b] : cross)
        if (a != b) meets[a] = meets[b] = true;
    constexpr std::size_t most = 2'000;  // their pairs are looked at
    if (all.size() > most) return;
    std::size_t turned = 0, dropped = 0;
    if (trusted && six_volumes(surface, surface.triangles) < 0) {  // all of it is inside out
        for (Corners& c : surface.triangles) std::swap(c[1], c[2]);
        for (Shell& shell : all) shell.sign = -shell.sign;
        turned = surface.triangles.size();
    }
    std::vector<char> gone(surface.triangles.size(), false);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].mesh) continue;  // part of a body whose facets are another's, too: it has no side of its own
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

using Pairs = std::vector<std::pair<int, int>>;

Pairs crossing_pairs(const Surface& surface) {
    const Mesh mesh = as_mesh(surface);
    return crossing_triangles(mesh, TriangleTree(mesh));
}

Vec3 middle(const Surface& surface, int t) {
    const Corners& c = surface.triangles[t];
    return (surface.vertices[c[0]] + surface.vertices[c[1]] + surface.vertices[c[2]]) / 3.0;
}

[[noreturn]] void throw_not_united(Vec3 at, const Pairs& crossed, const Pairs& left) {
    throw UnsoundSurface(fmt::format(
        "expected bodies that can be united, got {} of facets that cross, one near {}, and {} after that; unite them "
        "in "
        "the program that made them, or put each into a file of its own and write model(a) | model(b) in a scene",
        count_of(crossed.size(), "pair"), place(at), count_of(left.size(), "pair")));
}

// Replaces a surface that crosses itself at these pairs by the boundary of what it winds around.
void unite(Surface& surface, const Pairs& pairs, std::vector<std::string>& mended) {
    int count = 0;
    const std::vector<int> shell = shells_of(surface, count);
    std::vector<char> meets(std::size_t(count), false);
    bool between_shells = false;
    for (const auto& [a, b] : pairs) {
        between_shells = between_shells || shell[a] != shell[b];
        meets[shell[a]] = meets[shell[b]] = true;
    }
    const std::string said = fmt::format("{} of facets crossed", count_of(pairs.size(), "pair"));
    const Vec3 at = middle(surface, pairs[0].first);
    // Vertices that are made are rounded: what then reaches into another by that is united again.
    constexpr int passes = 4;
    Pairs left = pairs;
    try {
        for (int pass = 0; pass < passes && !left.empty(); ++pass) {
            const ClosedMesh whole(surface.vertices, surface.triangles);  // has no triangles without area
            UnitedShells united = united_shells(whole.vertices(), whole.triangles(), pass == 0);
            surface = welded({std::move(united.vertices), std::move(united.triangles)});
            drop_collapsed(surface);
            drop_doubles(surface);
            left = crossing_pairs(surface);
        }
    } catch (const NotClosed&) {
    } catch (const InsideOut& error) {
        throw UnsoundSurface(fmt::format(
            "expected bodies that face outward where they overlap, got {} of facets that cross and {} beside space "
            "that "
            "is inside out, one near {}; {}",
            count_of(pairs.size(), "pair"), count_of(error.count, "part"), place(error.place),
            between_shells ? "turn the body that faces inward in the program that made it, or subtract it there if it "
                             "is a hole"
                           : "repair it in the program that made it"));
    }
    const Openness open = openness(surface);
    if (!left.empty() || open.open > 0 || open.unturned > 0 || surface.triangles.empty())
        throw_not_united(at, pairs, left);
    mended.push_back(
        between_shells
            ? fmt::format("united {} shells that overlap, where {}", std::count(meets.begin(), meets.end(), true), said)
            : fmt::format("united what a shell that crosses itself winds around, where {}", said));
}

}  // namespace

ClosedSurface closed_surface(const TriangleSoup& soup) {
    ClosedSurface result;
    for (const Vec3& v : soup.vertices)
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(v[k])) throw UnsoundSurface("expected coordinates, got one that is not a number");
    if (soup.triangles.empty()) throw UnsoundSurface("expected a solid's surface, got no triangles");
    Surface surface = welded(soup);
    drop_collapsed(surface);
    // Two bodies may have a facet in common, which each of them needs.
    Surface with_doubles = surface;
    if (const std::size_t doubles = drop_doubles(surface)) {
        const Openness now = openness(surface), before = openness(with_doubles);
        if (now.open + now.unturned > before.open + before.unturned)
            surface = std::move(with_doubles);
        else
            result.mended.push_back(
                fmt::format("dropped {} that {} there twice", count_of(doubles, "facet"), doubles == 1 ? "is" : "are"));
    }
    Openness open = openness(surface);
    const double size = size_of(surface.vertices);
    for (const double tolerance : {1e-7, 1e-6, 1e-5}) {
        if (open.open == 0) break;
        Surface joined = surface;
        weld_rim(joined, open.rim, tolerance * size);
        const Openness now = openness(joined);
        if (now.open >= open.open) continue;
        if (now.open == 0)
            result.mended.push_back(
                fmt::format("joined vertices that lie within {:.2g} of one another", tolerance * size));
        surface = std::move(joined);
        open = now;
    }
    if (open.open > 0)
        throw UnsoundSurface(
            fmt::format("expected a closed surface, got one with {}, one near {}; close it in the program that made it",
                        count_of(open.open, "open edge"), place(open.place)));
    bool trusted = true;
    if (open.unturned > 0) {
        const long turned = turn_alike(surface);
        if (turned < 0)
            throw UnsoundSurface("expected a surface with an inside and an outside, got one that has a single side");
        result.mended.push_back(fmt::format("turned {} that faced inward", count_of(std::size_t(turned), "facet")));
        trusted = false;
    }
    const Pairs crossing = crossing_pairs(surface);
    settle_shells(surface, trusted, crossing, result.mended);
    if (!crossing.empty()) {
        unite(surface, crossing, result.mended);
        Surface flat = surface;
        flatten_faces(flat.vertices, flat.triangles);
        if (crossing_pairs(flat).empty()) surface = std::move(flat);
    } else {
        flatten_faces(surface.vertices, surface.triangles);
    }
    try {
        result.mesh = std::make_shared<ClosedMesh>(std::move(surface.vertices), std::move(surface.triangles));
    } catch (const NotClosed& error) {
        throw UnsoundSurface(fmt::format(
            "expected a surface with an inside and an outside, got {} whose triangles do not pair up, one near {}",
            count_of(error.count, "edge"), place(error.place)));
    }
    if (!crossing.empty()) {  // what has no area was dropped since
        const Pairs left = crossing_pairs({result.mesh->vertices(), result.mesh->triangles()});
        if (!left.empty()) throw_not_united(result.mesh->corner(left[0].first, 0), crossing, left);
    }
    if (!(result.mesh->size() > 0 && result.mesh->volume() > 0))
        throw UnsoundSurface("expected a solid's surface, got one that encloses nothing");
    return result;
}

}  // namespace deburr
