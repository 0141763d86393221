// Makes an octree's mesh: cells are cut, their crossings linked and made triangles, round by round, until none leans.
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

// How much smaller than those of its level cells may become.
constexpr int spare_levels = 6;

class OctreePolygonization {
public:
    /// `edge`: side of a cell. Keeps references to the solid, each of whose leaves has its number for a line, and to
    /// the options.
    OctreePolygonization(const SolidTree& solid, const Box& box, const OctreeOptions& options, double edge);

    /// The mesh, and where in the solid each of its triangles is from. Can be asked for again once cells were cut.
    Mesh run(OctreeStatistics& statistics, std::vector<Origin>& origins);

    /// Cuts the cells around these triangles; false if they are as small as may be.
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
    // In the first run, of free forms; gaps between touching polyhedra taper to nothing.
    bool looks_for_thin_;
    int gone_on_ = 0;
    Linking linking_;
    std::multimap<int, int> doubles_at_;  // of crossings
    std::vector<CrossingPoint> crossings_;
    std::unordered_map<std::uint64_t, CrossingPoint> known_crossings_;
    PointMesh mesh_;
    LeaningTriangles leaning_;
    std::vector<int> crossing_of_;             // of each triangle
    std::set<std::pair<int, int>> diagonals_;  // taken, where they may be asked for twice
};

}  // namespace deburr
