// Makes an octree's mesh: cells are cut, their crossings linked and triangulated, in rounds, until no triangle leans.
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "polygonizer/octree/octree.hpp"
#include "polygonizer/octree/octree_leaning.hpp"
#include "polygonizer/octree/octree_linking.hpp"
#include "polygonizer/octree/octree_points.hpp"

namespace deburr {

// How many times cells may be halved below the octree's level.
constexpr int spare_levels = 6;

/// The octree and its mesh, round by round.
class OctreePolygonization {
public:
    /// `edge` is the side of a cell. Keeps references to the solid, in which every leaf's `line` must be its number,
    /// and to the options.
    OctreePolygonization(const SolidTree& solid, const Box& box, const OctreeOptions& options, double edge);

    /// The mesh, and the origin of each triangle. It may be called again once cells were cut. Throws Cancelled.
    Mesh run(OctreeStatistics& statistics, std::vector<Origin>& origins);

    /// Cuts the cells around these triangles; false if all are as small as possible.
    bool cut_around(const Mesh& mesh, const std::vector<int>& triangles);

private:
    void refine(OctreeStatistics& statistics);
    void count_cells(OctreeStatistics& statistics) const;
    bool split(std::vector<int>& leaves);
    void go_on(std::size_t count);
    void place_crossings();
    CrossingPoint ends(const EdgeCrossing& x) const;
    Vec3 place(const EdgeCrossing& x, const CrossingPoint& ends) const;
    void place_points();
    void polygon_around(int crossing, std::vector<int>& polygon, std::size_t& middles);
    void add_middles_of_doubles();
    void make_triangles();
    void choose_diagonal(std::vector<int>& q, int crossing);
    void find_leaning(std::vector<int>& leaves) const;

    const OctreeOptions& options_;
    double hard_cosine_;
    CellTree tree_;
    bool has_forms_;
    // Whether thin parts are still searched for: in the first run, of free forms. Gaps between touching polyhedra taper
    // to nothing.
    bool looks_for_thin_;
    int gone_on_ = 0;
    Linking linking_;
    std::multimap<int, int> doubles_at_;  // index in Linking::doubles by crossing
    std::vector<CrossingPoint> crossings_;
    std::unordered_map<std::uint64_t, CrossingPoint> known_crossings_;
    PointMesh mesh_;
    LeaningTriangles leaning_;
    std::vector<int> crossing_of_;             // by triangle
    std::set<std::pair<int, int>> diagonals_;  // diagonals taken, where two quadrilaterals may share one
};

}  // namespace deburr
