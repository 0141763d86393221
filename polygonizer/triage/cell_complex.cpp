#include "polygonizer/triage/cell_complex.hpp"

#include <algorithm>
#include <cassert>
#include <map>

#include "bounds/sort_once.hpp"

namespace deburr {

CellComplex::CellComplex(const Box& box, double least_distance) : tolerance(least_distance) {
    for (int k = 0; k < 8; ++k)
        vertices.push_back({k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z});
    // The sides run counter-clockwise seen from inside, so that the box's cell is the front one.
    constexpr int sides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    std::map<std::pair<int, int>, int> known;
    cells.emplace_back();
    for (const auto& side : sides) {
        Face face{{}, outside, 0};
        for (int k = 0; k < 4; ++k) {
            const int a = side[k], b = side[(k + 1) % 4];
            const auto [it, fresh] = known.try_emplace(std::minmax(a, b), int(edges.size()));
            if (fresh) edges.push_back({a, b, {}});
            edges[it->second].faces.push_back(int(faces.size()));
            face.loop.push_back(2 * it->second + (edges[it->second].tail == a ? 0 : 1));
        }
        cells[0].push_back(int(faces.size()));
        faces.push_back(std::move(face));
    }
}

int CellComplex::across(int edge, int face, int cell) const {
    for (int other : edges[edge].faces)
        if (other != face && (faces[other].back == cell || faces[other].front == cell)) return other;
    assert(false && "an edge of a cell lies in two of its faces");
    return face;
}

const std::vector<int>& CellComplex::vertices_of(int cell) const {
    const std::array now{std::size_t(cell), vertices.size(), edges.size(), faces.size()};
    if (listed_ == now) return list_;
    listed_ = now;
    list_.clear();
    seen_.resize(vertices.size(), 0);
    ++stamp_;
    for (int f : cells[cell])
        for (Step s : faces[f].loop) {
            const int v = start(s);
            if (seen_[v] == stamp_) continue;
            seen_[v] = stamp_;
            list_.push_back(v);
        }
    return list_;
}

std::vector<int> CellComplex::corners(int face) const {
    std::vector<int> out;
    for (Step s : faces[face].loop) out.push_back(start(s));
    return out;
}

Vec3 CellComplex::area_vector(int face) const {
    const auto& loop = faces[face].loop;
    const Vec3 o = vertices[start(loop[0])];
    Vec3 sum(0.0);
    for (Step s : loop) sum += glm::cross(vertices[start(s)] - o, vertices[end(s)] - o);
    return sum;
}

namespace {

// A subset of the numbers below `count`, and the place of each number in it.
class Subset {
public:
    explicit Subset(std::size_t count) : place_(count, -1) {}

    void add(int number) {
        if (place_[number] >= 0) return;
        place_[number] = int(all_.size());
        all_.push_back(number);
    }
    void sort() {
        std::sort(all_.begin(), all_.end());
        for (std::size_t k = 0; k < all_.size(); ++k) place_[all_[k]] = int(k);
    }
    const std::vector<int>& all() const { return all_; }
    /// The place of a number; −1 if it is not in the subset.
    int operator[](int number) const { return place_[number]; }

private:
    std::vector<int> all_, place_;
};

}  // namespace

std::vector<int> CellComplex::with_neighbours(std::span<const int> of) const {
    std::vector<int> all(of.begin(), of.end());
    for (const int c : of)
        for (const int f : cells[c])
            for (const Step s : faces[f].loop)
                for (const int around : edges[s >> 1].faces)
                    for (const int beside : {faces[around].back, faces[around].front})
                        if (beside != outside) all.push_back(beside);
    sort_once(all);
    return all;
}

CellComplex CellComplex::part(std::span<const int> cells_of_part) const {
    Subset of_cells(cells.size()), of_faces(faces.size()), of_edges(edges.size()), of_vertices(vertices.size());
    for (const int c : cells_of_part) {
        of_cells.add(c);
        for (const int f : cells[c]) of_faces.add(f);
    }
    of_cells.sort();
    of_faces.sort();
    for (const int f : of_faces.all())
        for (const Step s : faces[f].loop) of_edges.add(s >> 1);
    of_edges.sort();
    for (const int e : of_edges.all()) {
        of_vertices.add(edges[e].tail);
        of_vertices.add(edges[e].head);
    }
    of_vertices.sort();
    CellComplex to(tolerance);
    for (const int v : of_vertices.all()) to.vertices.push_back(vertices[v]);
    for (const int e : of_edges.all()) {
        Edge& edge = to.edges.push_back({of_vertices[edges[e].tail], of_vertices[edges[e].head], {}});
        for (const int f : edges[e].faces)
            if (const int face = of_faces[f]; face >= 0) edge.faces.push_back(face);
    }
    for (const int f : of_faces.all()) {
        const auto cell = [&](int c) { return c == outside ? outside : of_cells[c]; };
        Face& face = to.faces.push_back({{}, cell(faces[f].back), cell(faces[f].front)});
        for (const Step s : faces[f].loop) face.loop.push_back(2 * of_edges[s >> 1] + (s & 1));
    }
    for (const int c : of_cells.all()) {
        List<12>& cell = to.cells.emplace_back();
        for (const int f : cells[c]) cell.push_back(of_faces[f]);
    }
    return to;
}

bool CellComplex::is_sound() const {
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& loop = faces[f].loop;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            if (end(loop[k]) != start(loop[(k + 1) % loop.size()])) return false;
            const auto& around = edges[loop[k] >> 1].faces;
            if (std::count(around.begin(), around.end(), int(f)) != 1) return false;
        }
        for (const int c : {faces[f].back, faces[f].front})
            if (c != outside && std::count(cells[c].begin(), cells[c].end(), int(f)) != 1) return false;
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
        std::map<int, int> uses;  // by edge: number of uses, plus 100 times the sum of their directions
        for (const int f : cells[c])
            for (const Step s : faces[f].loop) uses[s >> 1] += 1 + ((s & 1) == (faces[f].front == int(c)) ? 100 : -100);
        for (const auto& [edge, sum] : uses)
            if (sum != 2) return false;
        if (vertices_of(int(c)).size() + cells[c].size() != uses.size() + 2) return false;
    }
    return true;
}

int CellComplex::add_vertex(Vec3 x) {
    vertices.push_back(x);
    return int(vertices.size()) - 1;
}

int CellComplex::split_edge(int edge, Vec3 x) {
    const int middle = add_vertex(x), half = int(edges.size());
    edges.push_back({middle, edges[edge].head, edges[edge].faces});
    edges[edge].head = middle;
    for (int f : edges[edge].faces) {
        auto& loop = faces[f].loop;
        const auto at = std::find_if(loop.begin(), loop.end(), [&](Step s) { return s >> 1 == edge; });
        if (*at & 1)
            loop.insert(at, 2 * half + 1);
        else
            loop.insert(at + 1, 2 * half);
    }
    return middle;
}

int CellComplex::split_face(int face, int a, int b, std::span<const Vec3> between) {
    assert(a != b);
    const int fresh = int(faces.size());
    List<8> chain;
    int last = a;
    for (std::size_t k = 0; k <= between.size(); ++k) {
        const int next = k < between.size() ? add_vertex(between[k]) : b;
        chain.push_back(2 * int(edges.size()));
        edges.push_back({last, next, {face, fresh}});
        last = next;
    }
    auto& old = faces[face].loop;
    const auto from = std::find_if(old.begin(), old.end(), [&](Step s) { return start(s) == a; });
    assert(from != old.end());
    std::rotate(old.begin(), from, old.end());
    const auto to = std::find_if(old.begin(), old.end(), [&](Step s) { return start(s) == b; });
    assert(to != old.end());
    Face half{{old.begin(), to}, faces[face].back, faces[face].front};
    List<8> kept = chain;
    kept.append(to, old.end());
    for (Step s : half.loop) {
        auto& around = edges[s >> 1].faces;
        *std::find(around.begin(), around.end(), face) = fresh;
    }
    for (auto s = chain.end(); s != chain.begin();) half.loop.push_back(*--s ^ 1);
    old = std::move(kept);
    if (half.back != outside) cells[half.back].push_back(fresh);
    if (half.front != outside) cells[half.front].push_back(fresh);
    faces.push_back(std::move(half));
    return fresh;
}

int CellComplex::split_cell(int cell, std::span<const Step> loop, int seed, std::span<const VertexList> disc) {
    const int fresh = int(cells.size());
    cells.emplace_back();

    // The faces that the loop cuts off on the side of the seed move to the new cell.
    rim_.resize(edges.size(), 0);
    ++rim_stamp_;
    for (Step s : loop) rim_[s >> 1] = rim_stamp_;
    List<12> moved{seed};
    auto move = [&](int f) { (faces[f].back == cell ? faces[f].back : faces[f].front) = fresh; };
    move(seed);
    for (std::size_t k = 0; k < moved.size(); ++k)
        for (Step s : faces[moved[k]].loop) {
            if (rim_[s >> 1] == rim_stamp_) continue;
            for (int other : edges[s >> 1].faces)
                if (faces[other].back == cell || faces[other].front == cell) {
                    move(other);
                    moved.push_back(other);
                }
        }
    auto& old = cells[cell];
    old.erase(
        std::remove_if(old.begin(), old.end(), [&](int f) { return faces[f].back != cell && faces[f].front != cell; }),
        old.end());
    cells[fresh] = std::move(moved);

    // Steps are searched for from the last one, because recent ones are needed most often.
    struct Known {
        int from, to;
        Step step;
    };
    ShortList<Known, 24> known;
    for (Step s : loop) known.push_back({start(s), end(s), s});
    const auto step_between = [&](int a, int b) -> Step {
        for (auto k = known.end(); k != known.begin();) {
            --k;
            if (k->from == a && k->to == b) return k->step;
            if (k->from == b && k->to == a) return k->step ^ 1;
        }
        known.push_back({a, b, 2 * int(edges.size())});
        edges.push_back({a, b, {}});
        return known.back().step;
    };
    for (const VertexList& polygon : disc) {
        const int f = int(faces.size());
        Face face{{}, cell, fresh};
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Step s = step_between(polygon[k], polygon[(k + 1) % polygon.size()]);
            edges[s >> 1].faces.push_back(f);
            face.loop.push_back(s);
        }
        faces.push_back(std::move(face));
        cells[cell].push_back(f);
        cells[fresh].push_back(f);
    }
    return fresh;
}

}  // namespace deburr
