// Linking of surface points into polygons [Vyatkin §3.3].
//
// The paper walks along the border of the horizontal and of the vertical cross-section through a
// point to its neighbours, and joins four points A, B, C, D that are each other's neighbours to a
// quadrilateral. In an octree the cross-sections are the planes between its cells, and the walk from
// one point to the next passes through the face that two cells share. So:
//
//   crossing   an edge between cells of which one end is inside and the other outside
//   segment    of the border of a cross-section, in the face of two cells, from crossing to crossing
//   loop       of segments around a cell: one sheet of the surface passes here, so one surface point
//   polygon    around a crossing: the points of the three or four cells there, in turn
//
// Printed differently: the paper has one point a cell, and so joins sheets that meet in one (that is
// where its meshes are not manifolds), misses what the walk does not close (its holes), and finds
// each polygon once from every point of it. Here two segments end at every crossing in a cell, so
// loops close; a polygon belongs to a crossing, so it is there once; and it faces where the crossing
// leaves the solid.
#pragma once
#include "polygonizer/octree/octree_cells.hpp"

namespace deburr {

struct EdgeCrossing {
    GridPoint lo;      // of the edge's ends
    int axis, length;  // in units
    bool low_inside;
    std::array<int, 4> leaves;  // around it, counter-clockwise seen from where the axis points to
    std::array<int, 4> loops;   // of these leaves, that pass this crossing

    GridPoint hi() const {
        GridPoint c = lo;
        c[axis] += length;
        return c;
    }
};

struct Loop {
    int leaf;
    int begin, end;  // in Linking::around
};

/// Two segments in one face that join the same two loops: the edge between the loops' points is
/// there twice, and has to be told apart by a point in the middle of this one.
struct DoubleSegment {
    int loop_a, loop_b, crossing_a, crossing_b;
};

struct Linking {
    std::vector<EdgeCrossing> crossings;
    std::vector<Loop> loops;
    std::vector<int> around;  // crossings of the loops, in turn
    std::vector<DoubleSegment> doubles;
};

/// Throws std::logic_error where a loop does not close.
Linking link(CellTree& tree);

}  // namespace deburr
