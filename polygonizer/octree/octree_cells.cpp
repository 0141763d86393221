#include "polygonizer/octree/octree_cells.hpp"

#include <algorithm>
#include <stdexcept>

namespace deburr {
namespace {

// Planes of models lie at round coordinates. A grid that is offset from them by no simple fraction of a cell has no
// corners on them. Only neatness depends on it.
constexpr double off_round[3] = {0.3819660113, 0.2360679775, 0.4142135624};

// Cells are tested with this margin, relative to their side, so that a corner shared by a cell on one side and a cell
// that the surface may pass has the side of the former despite rounding.
constexpr double margin = 1e-6;

// A cell evaluates the solid pruned to this distance around it, in sides of the wanted cells: the middle of a triangle
// need not be in the cell that its surface passes.
constexpr double sight = 0.5;

// With no more half-spaces than this pruning costs more than it saves.
constexpr std::size_t few = 2;

// Three coordinates fit into 64 bits, with two bits to spare for an edge's axis (octree_polygonization.cpp).
constexpr int max_levels = 20;

std::uint64_t key_of(const GridPoint& c) {
    return std::uint64_t(c[0]) | std::uint64_t(c[1]) << 21 | std::uint64_t(c[2]) << 42;
}

}  // namespace

CellTree::CellTree(const SolidTree& solid, const Box& box, double edge, int spare, CancelFlag cancel,
                   std::size_t max_open)
    : cancel_(cancel), max_open_(max_open), edge_(edge) {
    // One more cell on either side keeps the surface away from the root's walls.
    const double cells = std::ceil(largest(box.hi - box.lo) / edge) + 3;
    level_ = int(std::min(std::ceil(std::log2(cells)), 1024.0));
    if (level_ + spare > max_levels) throw std::length_error("too many cells");
    const int across = 1 << (level_ + spare);
    unit_ = edge / double(1 << spare);
    const Vec3 middle = 0.5 * (box.lo + box.hi);
    for (int k = 0; k < 3; ++k) origin_[k] = middle[k] - unit_ * (across / 2) - edge * off_round[k];
    solids_.push_back(std::make_shared<SignedDistance>(solid));
    cells_.push_back({{0, 0, 0}, across, -1, 0, true});
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (cells_[i].open && cells_[i].size > (1 << spare)) add_children(int(i));
}

void CellTree::add_children(int parent) {
    throw_if_cancelled(cancel_);
    if (cells_.size() + 8 > max_cells || open_ > max_open_) throw std::length_error("too many cells");
    const OctreeCell p = cell(parent);
    cells_[parent].children = int(cells_.size());
    const int half = p.size / 2;
    open_ -= p.open;
    for (int k = 0; k < 8; ++k) {
        OctreeCell c{{p.at[0] + half * (k & 1), p.at[1] + half * (k >> 1 & 1), p.at[2] + half * (k >> 2)}, half};
        c.solid = p.solid;
        const Box wide = inflated(box(c), margin * unit_ * half);
        ++range_tests;
        c.open = solid(p).constant_side(wide) == 0;
        open_ += c.open;
        if (c.open && solid(p).half_spaces() > few) {
            auto local = std::make_shared<SignedDistance>(solid(p).within(inflated(wide, sight * edge_)));
            if (local->half_spaces() < solid(p).half_spaces()) {
                c.solid = int(solids_.size());
                solids_.push_back(std::move(local));
            }
        }
        cells_.push_back(c);
    }
}

bool CellTree::split(int leaf) {
    if (cell(leaf).size <= 1 || cell(leaf).children >= 0) return false;
    add_children(leaf);
    return true;
}

int CellTree::find(const GridPoint& unit, int size) const {
    const int across = cells_[0].size;
    for (const int x : unit)
        if (x < 0 || x >= across) return -1;
    int at = 0;
    while (cell(at).children >= 0 && cell(at).size > size) {
        const OctreeCell& c = cell(at);
        const int half = c.size / 2;
        at = c.children + (unit[0] >= c.at[0] + half) + 2 * (unit[1] >= c.at[1] + half) +
             4 * (unit[2] >= c.at[2] + half);
    }
    return at;
}

int CellTree::find(Vec3 x) const {
    GridPoint unit;
    for (int k = 0; k < 3; ++k)
        unit[k] = int(std::clamp(std::floor((x[k] - origin_[k]) / unit_), 0.0, double(cells_[0].size - 1)));
    return find(unit);
}

std::shared_ptr<const SignedDistance> CellTree::solid(const Box& box) const {
    const auto holds = [&](const OctreeCell& c) {
        const Box b = this->box(c);
        return b.contains(box.lo) && b.contains(box.hi);
    };
    int at = 0;
    while (cell(at).children >= 0) {
        int next = -1;
        for (int k = 0; k < 8 && next < 0; ++k)
            if (holds(cell(cell(at).children + k))) next = cell(at).children + k;
        if (next < 0) break;
        at = next;
    }
    const auto& around = solids_[cell(at).solid];
    if (around->half_spaces() <= few) return around;
    return std::make_shared<SignedDistance>(around->within(inflated(box, sight * edge_)));
}

double CellTree::value(const GridPoint& c, const OctreeCell& by) {
    const auto [it, is_new] = values_.try_emplace(key_of(c));
    if (is_new) it->second = solid(by).at(position(c)).distance;
    return it->second;
}

}  // namespace deburr
