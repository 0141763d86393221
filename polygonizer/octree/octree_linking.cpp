#include "polygonizer/octree/octree_linking.hpp"

#include <algorithm>
#include <stdexcept>

namespace deburr {
namespace {

/// A crossing on the border of the face between two leaves.
struct InFace {
    int a, b;  // leaves, a < b
    int crossing;
};

/// A segment, once for each of its two leaves.
struct Segment {
    int leaf, from, to;  // crossings
    int face;            // number of the segment, the same in both leaves
};

class Linker {
public:
    explicit Linker(CellTree& tree) : tree_(tree) {}

    Linking run() {
        for (std::size_t i = 0; i < tree_.cells().size(); ++i)
            if (tree_.cell(int(i)).children < 0 && tree_.cell(int(i)).open) find_crossings(int(i));
        join_in_faces();
        trace_loops();
        find_doubles();
        return std::move(linking_);
    }

private:
    // Finds crossings on those edges of the leaf of which no smaller cell has a part, and no earlier leaf has the edge.
    void find_crossings(int leaf) {
        const OctreeCell c = tree_.cell(leaf);
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t u = std::size_t(axis + 1) % 3, v = std::size_t(axis + 2) % 3;
            for (int k = 0; k < 4; ++k) {
                EdgeCrossing x;
                x.axis = axis;
                x.length = c.size;
                x.lo = c.at;
                x.lo[u] += k & 1 ? c.size : 0;
                x.lo[v] += k & 2 ? c.size : 0;
                x.low_inside = tree_.value(x.lo, c) > 0;
                if (x.low_inside == (tree_.value(x.hi(), c) > 0)) continue;
                if (leaves_around(x, leaf)) linking_.crossings.push_back(x);
            }
        }
    }

    /// Sets the leaves around the crossing; false if it is a smaller or an earlier leaf's.
    bool leaves_around(EdgeCrossing& x, int leaf) {
        const std::size_t u = std::size_t(x.axis + 1) % 3, v = std::size_t(x.axis + 2) % 3;
        constexpr int side_u[4] = {-1, 0, 0, -1}, side_v[4] = {-1, -1, 0, 0};
        bool owner = true;
        for (std::size_t q = 0; q < 4; ++q) {
            GridPoint unit = x.lo;
            unit[u] += side_u[q];
            unit[v] += side_v[q];
            const int there = tree_.find(unit, x.length);
            if (there < 0) throw std::logic_error("the surface leaves the octree");
            const OctreeCell& c = tree_.cell(there);
            if (c.children >= 0) return false;
            owner &= there >= leaf || c.size > x.length || !c.open;
            x.leaves[q] = there;
        }
        return owner;
    }

    // Joins the crossings on the border of every face between two leaves in pairs.
    void join_in_faces() {
        std::vector<InFace> all;
        for (std::size_t i = 0; i < linking_.crossings.size(); ++i) {
            const auto& leaves = linking_.crossings[i].leaves;
            for (std::size_t q = 0; q < 4; ++q) {
                const int a = leaves[q], b = leaves[(q + 1) % 4];
                if (a != b) all.push_back({std::min(a, b), std::max(a, b), int(i)});
            }
        }
        std::sort(all.begin(), all.end(), [](const InFace& x, const InFace& y) {
            return std::tie(x.a, x.b, x.crossing) < std::tie(y.a, y.b, y.crossing);
        });
        for (std::size_t i = 0; i < all.size();) {
            std::size_t end = i;
            while (end < all.size() && all[end].a == all[i].a && all[end].b == all[i].b) ++end;
            if ((end - i) % 2) throw std::logic_error("a cross-section's border does not close");
            if (end - i == 2)
                add_segment(all[i], all[i].crossing, all[i + 1].crossing);
            else
                join_many({all.begin() + std::ptrdiff_t(i), all.begin() + std::ptrdiff_t(end)});
            i = end;
        }
    }

    void add_segment(const InFace& face, int from, int to) {
        segments_.push_back({face.a, from, to, faces_});
        segments_.push_back({face.b, from, to, faces_});
        ++faces_;
    }

    // Joins four crossings or more: the side of the face's middle decides which arcs of the border are cut off [Vyatkin
    // §2.5, face center sampling].
    void join_many(std::vector<InFace> face) {
        const OctreeCell &a = tree_.cell(face[0].a), &b = tree_.cell(face[0].b);
        const OctreeCell& small = a.size <= b.size ? a : b;
        const OctreeCell& other = a.size <= b.size ? b : a;
        std::size_t axis = 0;
        while (small.at[axis] + small.size != other.at[axis] && other.at[axis] + other.size != small.at[axis]) ++axis;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        GridPoint corner = small.at;
        if (small.at[axis] + small.size == other.at[axis]) corner[axis] += small.size;
        // Position along the border, from the lower corner along u, and whether the border enters the solid there.
        struct On {
            int along, crossing;
            bool enters;
        };
        std::vector<On> border;
        for (const InFace& f : face) {
            const EdgeCrossing& x = linking_.crossings[f.crossing];
            const bool on_u = std::size_t(x.axis) == u;
            const bool far = on_u ? x.lo[v] != corner[v] : x.lo[u] != corner[u];
            const int step = on_u ? x.lo[u] - corner[u] : x.lo[v] - corner[v];
            const bool backward = on_u == far;
            const int along = on_u ? (far ? 3 * small.size - step - x.length : step)
                                   : (far ? small.size + step : 4 * small.size - step - x.length);
            border.push_back({along, f.crossing, x.low_inside == backward});
        }
        std::sort(border.begin(), border.end(), [](const On& x, const On& y) { return x.along < y.along; });
        Vec3 middle = tree_.position(corner);
        middle[int(u)] += 0.5 * tree_.unit() * small.size;
        middle[int(v)] += 0.5 * tree_.unit() * small.size;
        const bool joined = tree_.solid(small.open ? small : other).inside(middle);
        for (std::size_t i = 0; i < border.size(); ++i) {
            const On &from = border[i], &to = border[(i + 1) % border.size()];
            if (from.enters == to.enters) throw std::logic_error("a cross-section's border is not in turns");
            if (from.enters != joined) add_segment(face[0], from.crossing, to.crossing);
        }
    }

    void trace_loops() {
        std::sort(segments_.begin(), segments_.end(), [](const Segment& x, const Segment& y) {
            return std::tie(x.leaf, x.face) < std::tie(y.leaf, y.face);
        });
        loop_of_.assign(2 * std::size_t(faces_), -1);
        for (std::size_t i = 0; i < segments_.size();) {
            std::size_t end = i;
            while (end < segments_.size() && segments_[end].leaf == segments_[i].leaf) ++end;
            trace_leaf(i, end);
            i = end;
        }
    }

    void trace_leaf(std::size_t begin, std::size_t end) {
        std::vector<char> used(end - begin, false);
        for (std::size_t first = begin; first < end; ++first) {
            if (used[first - begin]) continue;
            const int id = int(linking_.loops.size()), start = segments_[first].from;
            Loop loop{segments_[first].leaf, int(linking_.around.size()), 0};
            int at = start;
            std::size_t s = first;
            do {
                used[s - begin] = true;
                set_loop(at, loop.leaf, id);
                linking_.around.push_back(at);
                note(segments_[s], id);
                at = segments_[s].from == at ? segments_[s].to : segments_[s].from;
                if (at == start) break;
                for (s = begin; s < end; ++s)
                    if (!used[s - begin] && (segments_[s].from == at || segments_[s].to == at)) break;
                if (s == end) throw std::logic_error("a loop around a cell does not close");
            } while (true);
            loop.end = int(linking_.around.size());
            linking_.loops.push_back(loop);
        }
    }

    void set_loop(int crossing, int leaf, int loop) {
        EdgeCrossing& x = linking_.crossings[crossing];
        for (std::size_t q = 0; q < 4; ++q)
            if (x.leaves[q] == leaf) x.loops[q] = loop;
    }

    void note(const Segment& s, int loop) {
        int& first = loop_of_[2 * std::size_t(s.face)];
        (first < 0 ? first : loop_of_[2 * std::size_t(s.face) + 1]) = loop;
    }

    void find_doubles() {
        struct Joined {
            int a, b, from, to;
        };
        std::vector<Joined> all;
        std::vector<char> seen(std::size_t(faces_), false);
        for (const Segment& s : segments_) {
            if (seen[s.face]) continue;
            seen[s.face] = true;
            const int a = loop_of_[2 * std::size_t(s.face)], b = loop_of_[2 * std::size_t(s.face) + 1];
            all.push_back({a, b, s.from, s.to});
        }
        std::sort(all.begin(), all.end(), [](const Joined& x, const Joined& y) {
            return std::tie(x.a, x.b, x.from, x.to) < std::tie(y.a, y.b, y.from, y.to);
        });
        for (std::size_t i = 1; i < all.size(); ++i)
            if (all[i].a == all[i - 1].a && all[i].b == all[i - 1].b)
                linking_.doubles.push_back({all[i].a, all[i].b, all[i].from, all[i].to});
    }

    CellTree& tree_;
    Linking linking_;
    std::vector<Segment> segments_;
    std::vector<int> loop_of_;  // two loops for each segment
    int faces_ = 0;
};

}  // namespace

Linking link(CellTree& tree) { return Linker(tree).run(); }

}  // namespace deburr
