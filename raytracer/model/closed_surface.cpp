#include "raytracer/model/closed_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "polygonizer/mesh/crossing_triangles.hpp"
#include "raytracer/model/file_surface.hpp"
#include "raytracer/model/flat_faces.hpp"
#include "raytracer/model/shell_sides.hpp"
#include "raytracer/model/united_shells.hpp"
#include "raytracer/util/count_text.hpp"

namespace deburr {
namespace {

using Corners = ClosedMesh::Corners;

std::string place(Vec3 x) { return fmt::format("{{{:.6g}, {:.6g}, {:.6g}}}", x.x, x.y, x.z); }

double size_of(const std::vector<Vec3>& vertices) {
    Box box;
    for (const Vec3& v : vertices) box = hull(box, Box{v, v});
    return box.empty() ? 0 : largest(box.hi - box.lo);
}

Mesh as_mesh(const FileSurface& surface) {
    Mesh mesh;
    mesh.positions = surface.vertices;
    for (const Corners& t : surface.triangles) mesh.triangles.push_back({t, {0, 0, 0}});
    return mesh;
}

using Pairs = std::vector<std::pair<int, int>>;

Pairs crossing_pairs(const FileSurface& surface) {
    const Mesh mesh = as_mesh(surface);
    return crossing_triangles(mesh, TriangleTree(mesh));
}

Vec3 middle(const FileSurface& surface, int t) {
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

// Replaces a surface that crosses itself at these pairs of triangles by the boundary of what it winds around.
void unite(FileSurface& surface, const Pairs& pairs, std::vector<std::string>& mended) {
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
    // New vertices are rounded; parts that cross because of that are united again.
    constexpr int passes = 4;
    Pairs left = pairs;
    try {
        for (int pass = 0; pass < passes && !left.empty(); ++pass) {
            const ClosedMesh whole(surface.vertices, surface.triangles);  // which drops triangles without area
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

void check_coordinates(const TriangleSoup& soup) {
    for (const Vec3& v : soup.vertices)
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(v[k])) throw UnsoundSurface("expected coordinates, got one that is not a number");
    if (soup.triangles.empty()) throw UnsoundSurface("expected a solid's surface, got no triangles");
}

// Drops duplicate facets, unless that opens the surface: two bodies may share a facet that each of them needs.
void drop_needless_doubles(FileSurface& surface, std::vector<std::string>& mended) {
    FileSurface with_doubles = surface;
    const std::size_t doubles = drop_doubles(surface);
    if (doubles == 0) return;
    const Openness now = openness(surface), before = openness(with_doubles);
    if (now.open + now.unturned > before.open + before.unturned)
        surface = std::move(with_doubles);
    else
        mended.push_back(
            fmt::format("dropped {} that {} there twice", count_of(doubles, "facet"), doubles == 1 ? "is" : "are"));
}

// Closes the surface by joining vertices along its open edges, within the least tolerance that suffices; throws if none
// does. Returns what remains to be turned.
Openness close_rims(FileSurface& surface, std::vector<std::string>& mended) {
    Openness open = openness(surface);
    const double size = size_of(surface.vertices);
    for (const double tolerance : {1e-7, 1e-6, 1e-5}) {
        if (open.open == 0) break;
        FileSurface joined = surface;
        weld_rim(joined, open.rim, tolerance * size);
        const Openness now = openness(joined);
        if (now.open >= open.open) continue;
        if (now.open == 0)
            mended.push_back(fmt::format("joined vertices that lie within {:.2g} of one another", tolerance * size));
        surface = std::move(joined);
        open = now;
    }
    if (open.open > 0)
        throw UnsoundSurface(
            fmt::format("expected a closed surface, got one with {}, one near {}; close it in the program that made it",
                        count_of(open.open, "open edge"), place(open.place)));
    return open;
}

void turn_facets_alike(FileSurface& surface, std::vector<std::string>& mended) {
    const long turned = turn_alike(surface);
    if (turned < 0)
        throw UnsoundSurface("expected a surface with an inside and an outside, got one that has a single side");
    mended.push_back(fmt::format("turned {} that faced inward", count_of(std::size_t(turned), "facet")));
}

// Unites shells that cross, if any, and flattens faces that a file's single precision bent, unless that makes facets
// cross.
void unite_and_flatten(FileSurface& surface, const Pairs& crossing, std::vector<std::string>& mended) {
    if (crossing.empty()) {
        flatten_faces(surface.vertices, surface.triangles);
        return;
    }
    unite(surface, crossing, mended);
    FileSurface flat = surface;
    flatten_faces(flat.vertices, flat.triangles);
    if (crossing_pairs(flat).empty()) surface = std::move(flat);
}

std::shared_ptr<ClosedMesh> closed_mesh(FileSurface surface) {
    try {
        return std::make_shared<ClosedMesh>(std::move(surface.vertices), std::move(surface.triangles));
    } catch (const NotClosed& error) {
        throw UnsoundSurface(fmt::format(
            "expected a surface with an inside and an outside, got {} whose triangles do not pair up, one near {}",
            count_of(error.count, "edge"), place(error.place)));
    }
}

}  // namespace

ClosedSurface closed_surface(const TriangleSoup& soup) {
    check_coordinates(soup);
    ClosedSurface result;
    FileSurface surface = welded(soup);
    drop_collapsed(surface);
    drop_needless_doubles(surface, result.mended);
    const bool trusted = close_rims(surface, result.mended).unturned == 0;
    if (!trusted) turn_facets_alike(surface, result.mended);
    const Pairs crossing = crossing_pairs(surface);
    settle_shells(surface, trusted, crossing, result.mended);
    unite_and_flatten(surface, crossing, result.mended);
    result.mesh = closed_mesh(std::move(surface));
    if (!crossing.empty()) {  // ClosedMesh has dropped triangles without area
        const Pairs left = crossing_pairs({result.mesh->vertices(), result.mesh->triangles()});
        if (!left.empty()) throw_not_united(result.mesh->corner(left[0].first, 0), crossing, left);
    }
    if (!(result.mesh->size() > 0 && result.mesh->volume() > 0))
        throw UnsoundSurface("expected a solid's surface, got one that encloses nothing");
    return result;
}

}  // namespace deburr
