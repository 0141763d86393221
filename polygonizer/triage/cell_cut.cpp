// Cuts a cell by a plane: a vertex on each edge that it crosses, an edge across each face, and a face across the cell.
#include <algorithm>
#include <cassert>

#include "polygonizer/triage/cell_complex.hpp"

namespace deburr {

/// Sets side_ of the cell's vertices and reach_ of its faces; false if the cell does not have vertices on both sides.
bool CellComplex::classify(int cell, const Plane& plane) {
    side_.resize(vertices.size());
    bool above = false, below = false;
    for (int v : vertices_of(cell)) {
        const double d = plane.distance(vertices[v]);
        side_[v] = d > tolerance ? 1 : d < -tolerance ? -1 : 0;
        above |= side_[v] > 0;
        below |= side_[v] < 0;
    }
    if (!above || !below) return false;
    reach_.clear();
    for (int f : cells[cell]) {
        Reach& reach = reach_.emplace_back(Reach{f, false, false});
        for (Step s : faces[f].loop) {
            reach.above |= side_[start(s)] > 0;
            reach.below |= side_[start(s)] < 0;
        }
    }
    return true;
}

const CellComplex::Reach& CellComplex::reach_of(int face) const {
    return *std::find_if(reach_.begin(), reach_.end(), [&](const Reach& r) { return r.face == face; });
}

// Whether the cut is one simple loop: every face is crossed not at all or in two places, each an edge or a vertex, and
// these places are joined to a single ring.
bool CellComplex::cut_is_simple(int cell) {
    auto& links = joins_;  // places: ~edge if it is crossed, or vertex
    links.clear();
    for (const Reach& reach : reach_) {
        if (!reach.above) continue;
        const auto& loop = faces[reach.face].loop;
        const std::size_t n = loop.size();
        if (reach.below) {
            int cut_points[2], count = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const int here = start(loop[k]), next = end(loop[k]);
                int cut_point;
                if (side_[here] * side_[next] < 0) {
                    cut_point = ~(loop[k] >> 1);
                } else if (side_[next] == 0 && side_[here] != 0) {
                    const int after = side_[end(loop[k + 1 < n ? k + 1 : 0])];
                    if (after == side_[here]) continue;  // touches only
                    if (after == 0) return false;        // an edge on the plane between both sides
                    cut_point = next;
                } else {
                    continue;
                }
                if (count == 2) return false;
                cut_points[count++] = cut_point;
            }
            if (count != 2) return false;
            links.push_back({cut_points[0], cut_points[1]});
        } else {
            for (Step s : loop) {
                if (side_[start(s)] != 0 || side_[end(s)] != 0) continue;
                const Reach& other = reach_of(across(s >> 1, reach.face, cell));
                if (other.above) continue;
                if (!other.below) return false;  // a whole face on the plane within the cut
                links.push_back({start(s), end(s)});
            }
        }
    }
    if (links.size() < 3) return false;
    // Walks along the ring.
    int at = links[0].to;
    links[0].used = true;
    std::size_t walked = 1;
    while (at != links[0].from) {
        Join* next = nullptr;
        for (Join& join : links) {
            if (join.used || (join.from != at && join.to != at)) continue;
            if (next) return false;
            next = &join;
        }
        if (!next) return false;
        next->used = true;
        ++walked;
        at = next->from == at ? next->to : next->from;
    }
    return walked == links.size();
}

// Puts a vertex on every edge of the cell that the plane crosses.
void CellComplex::split_crossed_edges(const Plane& plane) {
    for (const Reach& reach : reach_) {
        if (!reach.above || !reach.below) continue;
        auto& loop = faces[reach.face].loop;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Step s = loop[k];
            const int a = start(s), b = end(s);
            if (side_[a] * side_[b] >= 0) continue;
            const double da = plane.distance(vertices[a]), db = plane.distance(vertices[b]);
            Vec3 x = vertices[a] + (vertices[b] - vertices[a]) * (da / (da - db));
            x -= plane.normal * plane.distance(x);
            split_edge(s >> 1, x);
            side_.push_back(0);
        }
    }
}

// Splits a face with vertices on both sides; the part below keeps the face's number. Returns the part above.
int CellComplex::split_crossed_face(int face) {
    const auto& loop = faces[face].loop;
    int from = -1, to = -1;  // the half with the positive side runs from `from` to `to`
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const int before = side_[start(loop[k])], v = end(loop[k]);
        if (side_[v] != 0) continue;
        const int after = side_[end(loop[k + 1 < loop.size() ? k + 1 : 0])];
        if (before < 0 && after > 0) from = v;
        if (before > 0 && after < 0) to = v;
    }
    return split_face(face, from, to);
}

// Splits the faces that the plane crosses. Returns a face above the plane; `ring` becomes the edges of the cut, in no
// order.
int CellComplex::split_crossed_faces(int cell, List<8>& ring) {
    int above = -1;
    for (const Reach& reach : reach_) {
        if (!reach.above) continue;
        if (reach.below) {
            above = split_crossed_face(reach.face);
            ring.push_back(2 * (int(edges.size()) - 1));
            continue;
        }
        above = reach.face;
        for (Step s : faces[reach.face].loop) {
            // No face that was split has an edge on the plane, so both faces at this edge are in reach_.
            if (side_[start(s)] != 0 || side_[end(s)] != 0) continue;
            if (!reach_of(across(s >> 1, reach.face, cell)).above) ring.push_back(s);
        }
    }
    return above;
}

// Orders the steps of a ring so that each starts where the one before ends.
void CellComplex::order(List<8>& ring) const {
    for (std::size_t k = 0; k + 1 < ring.size(); ++k)
        for (std::size_t j = k + 1; j < ring.size(); ++j) {
            if (start(ring[j]) != end(ring[k]) && end(ring[j]) != end(ring[k])) continue;
            if (start(ring[j]) != end(ring[k])) ring[j] ^= 1;
            std::swap(ring[k + 1], ring[j]);
            break;
        }
}

// Whether, at the ring's first edge, the ring runs as the loop of the cell's face above the cut does, seen from the
// cell. That is decided combinatorially, not by the area of what may be a sliver.
bool CellComplex::runs_with_upper_face(int cell, const List<8>& ring) const {
    const int upper_face = [&] {
        for (int f : edges[ring[0] >> 1].faces) {
            if (faces[f].back != cell && faces[f].front != cell) continue;
            for (Step s : faces[f].loop)
                if (side_[start(s)] > 0) return f;
        }
        return -1;
    }();
    assert(upper_face >= 0);
    bool along = false;
    for (Step s : faces[upper_face].loop)
        if (s >> 1 == ring[0] >> 1) along = s == ring[0];
    // Seen from the new cell, a face's loop runs counter-clockwise if the cell is its front cell.
    return along == (faces[upper_face].front == cell);
}

int CellComplex::cut(int cell, const Plane& plane) {
    if (!classify(cell, plane) || !cut_is_simple(cell)) return -1;
    split_crossed_edges(plane);
    List<8> ring;
    const int above = split_crossed_faces(cell, ring);
    order(ring);
    VertexList polygon;
    for (Step s : ring) polygon.push_back(start(s));
    // The new face's loop must run opposite to that of the face above it.
    if (runs_with_upper_face(cell, ring)) std::reverse(polygon.begin(), polygon.end());
    return split_cell(cell, ring, above, {&polygon, 1});
}

}  // namespace deburr
