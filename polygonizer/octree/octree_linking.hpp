// Links surface points to polygons [Vyatkin §3.3].
//
// The paper walks from a point to its neighbours along the border of the horizontal and the vertical cross-section
// through the point, and joins four points A, B, C, D that are each other's neighbours to a quadrilateral. In an octree
// the cross-sections are the planes between its cells, and the walk from one point to the next passes through the face
// that two cells share. So:
//
//   crossing   an edge between cells with one end inside and the other outside
//   segment    of the border of a cross-section, in the face between two cells, from crossing to crossing
//   loop       segments around a cell: one sheet of the surface passes here, so there is one surface point
//   polygon    around a crossing: the points of the three or four cells there, in order
//
// Printed differently: the paper has one point in a cell. So it joins sheets that meet in one (where its meshes are not
// manifolds), misses polygons that the walk does not close (its holes), and finds every polygon once from each of its
// points. Here two segments end at every crossing in a cell, so loops close; a polygon belongs to a crossing, so it
// occurs once; and it faces where the crossing leaves the solid.
#pragma once
#include "polygonizer/octree/octree_cells.hpp"

namespace deburr {

/// An edge between cells with one end inside and the other outside.
struct EdgeCrossing {
    GridPoint lo;      // lower end
    int axis, length;  // direction, 0 … 2, and length in units
    /// Whether the lower end is inside.
    bool low_inside;
    std::array<int, 4> leaves;  // leaves around it, counter-clockwise seen from the end that the axis points to
    std::array<int, 4> loops;   // the loop of each of these leaves that passes this crossing

    GridPoint hi() const {
        GridPoint c = lo;
        c[axis] += length;
        return c;
    }
};

/// A closed sequence of segments around a leaf: one sheet of the surface in it.
struct Loop {
    int leaf;
    int begin, end;  // range in Linking::around
};

/// Two segments in one face that join the same two loops. The edge between the loops' points would occur twice, so one
/// of the two gets a point in the middle, that of this segment.
struct DoubleSegment {
    int loop_a, loop_b, crossing_a, crossing_b;
};

/// The crossings and loops of an octree.
struct Linking {
    std::vector<EdgeCrossing> crossings;
    std::vector<Loop> loops;
    std::vector<int> around;  // crossings of all loops, in order around each
    std::vector<DoubleSegment> doubles;
};

/// Links the octree's crossings. Throws std::logic_error where a loop does not close.
Linking link(CellTree& tree);

}  // namespace deburr
