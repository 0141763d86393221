// The half-edges of triangles, in the order of their edges: what meshes are paired, joined and checked by.
#pragma once
#include <array>
#include <span>
#include <vector>

namespace deburr {

/// An edge of a triangle: from its corner k to the next one.
struct HalfEdge {
    int lo, hi;  // indices of the edge's vertices; lo ≤ hi
    bool up;     // whether it runs from lo to hi
    int triangle, k;
};

/// The half-edges of all triangles, sorted by lo, hi, triangle and k.
std::vector<HalfEdge> sorted_half_edges(std::span<const std::array<int, 3>> triangles);

/// Calls visit(half_edges) once for each edge, with a std::span of its half-edges. `sorted` is sorted_half_edges()'s.
template <class Visit>
void each_edge(std::span<const HalfEdge> sorted, Visit visit) {
    for (std::size_t first = 0, end; first < sorted.size(); first = end) {
        end = first + 1;
        while (end < sorted.size() && sorted[end].lo == sorted[first].lo && sorted[end].hi == sorted[first].hi) ++end;
        visit(sorted.subspan(first, end - first));
    }
}

}  // namespace deburr
