#include "polygonizer/triage/subspace.hpp"

#include <algorithm>
#include <numeric>

#include "polygonizer/triage/loop_disc.hpp"

namespace deburr {

Vec3 root_between(const LocalDensity& density, Vec3 a, double fa, Vec3 b, double fb) {
    // Regula falsi with interleaved bisection [Triage §4.4.1], in the form of the Illinois method.
    double ta = 0, tb = 1;
    double wa = fa, wb = fb;
    int kept = 0;
    for (int k = 0; k < 200; ++k) {
        double t = (ta * wb - tb * wa) / (wb - wa);
        if (!(t > ta && t < tb) || k % 4 == 3) t = 0.5 * (ta + tb);
        if (t <= ta || t >= tb || tb - ta < 1e-15) return a + (b - a) * (std::abs(wa) < std::abs(wb) ? ta : tb);
        const double f = density.at(a + (b - a) * t) - 0.5;
        if (std::abs(f) < 1e-16) return a + (b - a) * t;
        if ((f > 0) == (fa > 0)) {
            ta = t;
            wa = f;
            if (kept == -1) wb *= 0.5;
            kept = -1;
        } else {
            tb = t;
            wb = f;
            if (kept == 1) wa *= 0.5;
            kept = 1;
        }
    }
    return a + (b - a) * (0.5 * (ta + tb));
}

Subspace::Subspace(const Subdivision& subdivision, double slack)
    : subdivision_(subdivision), complex_(subdivision.complex), slack_(slack), whole_(true) {
    undivided_.resize(complex_.cells.size());
    std::iota(undivided_.begin(), undivided_.end(), 0);
    open_ = undivided_;
    begin();
}

// The cells beside the given ones are included, because they tell on which side of a leaf the borders are.
Subspace::Subspace(const Subdivision& subdivision, std::span<const int> cells, double slack)
    : subdivision_(subdivision),
      undivided_(subdivision.complex.with_neighbours(cells)),
      complex_(subdivision.complex.part(undivided_)),
      slack_(slack),
      whole_(false) {
    for (const int c : cells)
        open_.push_back(int(std::lower_bound(undivided_.begin(), undivided_.end(), c) - undivided_.begin()));
    begin();
}

void Subspace::begin() {
    root_.resize(complex_.cells.size());
    std::iota(root_.begin(), root_.end(), 0);
    leaf_of_face_.assign(complex_.faces.size(), -1);
    next_of_root_.assign(complex_.cells.size(), -1);
    resolved_.resize(complex_.cells.size());
    for (const int c : undivided_)
        is_cut_.push_back(subdivision_.nodes[subdivision_.node_of[c]].side != Side::straddling);
    for (const int c : open_) is_cut_[c] = true;
}

double Subspace::slack_in(int cell) const {
    if (cell == CellComplex::outside || slack_ == 0) return slack_;
    return subdivision_.nodes[subdivision_.node_of[origin(cell)]].open.size() > 1 ? 0 : slack_;
}

void Subspace::polygonize() {
    std::vector<std::pair<int, int>> open;  // leaf and undivided cell
    for (const int c : open_)
        for (const OpenLeaf& o : subdivision_.nodes[subdivision_.node_of[undivided_[c]]].open)
            open.push_back({o.leaf, c});
    std::sort(open.begin(), open.end());
    std::vector<int> cells;
    for (std::size_t k = 0; k < open.size();) {
        const int leaf = open[k].first;
        cells.clear();
        for (; k < open.size() && open[k].first == leaf; ++k)
            for (int c = open[k].second; c >= 0; c = next_of_root_[c]) cells.push_back(c);
        std::sort(cells.begin(), cells.end());
        cut_by(leaf, cells);
    }
    for (Signs* signs : {&vertex_signs_, &edge_signs_, &face_labels_, &sides_}) *signs = {};
}

Side Subspace::side(int cell, int leaf) const {
    if (cell == CellComplex::outside) return Side::straddling;
    for (const auto& [l, side] : resolved_[cell])
        if (l == leaf) return side;
    return subdivision_.side(origin(cell), leaf);
}

// The side with respect to leaf_, as it was before the first cell is spanned.
Side Subspace::side_now(int cell) {
    if (cell == CellComplex::outside) return Side::straddling;
    Sign known = sides_.at(cell);
    if (known == Sign::unknown) {
        const Side side = this->side(cell, leaf_);
        known = side == Side::inside ? Sign::above : side == Side::outside ? Sign::below : Sign::none;
        sides_.set(cell, known);
    }
    return known == Sign::above ? Side::inside : known == Sign::below ? Side::outside : Side::straddling;
}

bool Subspace::inside(int cell) const {
    if (cell == CellComplex::outside) return false;
    const PartitionNode& node = subdivision_.nodes[subdivision_.node_of[origin(cell)]];
    if (node.side != Side::straddling) return node.side == Side::inside;
    in_.clear();
    for (const SolidTreeNode& n : node.solid) {
        const auto at = [&](int child) { return bool(in_[child]); };
        switch (n.op) {
            case SolidOp::nothing: in_.push_back(false); break;
            case SolidOp::everything: in_.push_back(true); break;
            case SolidOp::leaf: in_.push_back(side(cell, n.a) == Side::inside); break;
            case SolidOp::unite: in_.push_back(at(n.a) || at(n.b)); break;
            case SolidOp::intersect: in_.push_back(at(n.a) && at(n.b)); break;
            case SolidOp::subtract: in_.push_back(at(n.a) && !at(n.b)); break;
        }
    }
    return in_.back();
}

void Subspace::cut_by(int leaf, const std::vector<int>& open) {
    leaf_ = leaf;
    for (Signs* signs : {&vertex_signs_, &edge_signs_, &face_labels_, &sides_}) signs->forget();
    std::vector<std::pair<int, int>> to_split;  // face and open cell
    for (const int c : open)
        for (const int f : complex_.cells[c]) {
            if (face_labels_.at(f) != Sign::unknown) continue;
            const Side beyond = side_now(complex_.neighbour(f, c));
            if (beyond == Side::straddling) {
                face_labels_.set(f, Sign::none);
                to_split.push_back({f, c});
            } else {
                face_labels_.set(f, beyond == Side::inside ? Sign::above : Sign::below);
            }
        }
    const auto density = [&](int cell) -> const LocalDensity& { return *this->open(cell, leaf)->density; };
    for (const auto& [f, c] : to_split) split_edges(f, density(c));
    for (const auto& [f, c] : to_split) split_face(f, density(c));
    for (const int c : open) span(c, density(c));
}

Subspace::Sign Subspace::point_sign(Vec3 x, const LocalDensity& density) const {
    const ValueGradient v = density.gradient_at(x);
    const double f = v.value - 0.5;
    if (std::abs(f) <= on_level + 3 * complex_.tolerance * glm::length(v.gradient)) return Sign::none;
    return f > 0 ? Sign::above : Sign::below;
}

Subspace::Sign Subspace::vertex_sign(int vertex, const LocalDensity& density) {
    Sign sign = vertex_signs_.at(vertex);
    if (sign == Sign::unknown) {
        sign = point_sign(complex_.vertices[vertex], density);
        vertex_signs_.set(vertex, sign);
    }
    return sign;
}

// The decided cells around an edge determine its sign: none if they disagree. Only if all are undecided, the edge's
// ends are evaluated.
Subspace::Sign Subspace::edge_sign(int edge, const LocalDensity& density) {
    bool in = false, out = false;
    const auto& e = complex_.edges[edge];
    for (const int f : e.faces)
        for (const int c : {complex_.faces[f].back, complex_.faces[f].front}) {
            const Side s = side_now(c);
            in |= s == Side::inside;
            out |= s == Side::outside;
        }
    if (in || out) return in && out ? Sign::none : in ? Sign::above : Sign::below;
    const Sign a = vertex_sign(e.tail, density), b = vertex_sign(e.head, density);
    if (a != Sign::none && b != Sign::none) return a == b ? a : Sign::unknown;  // unknown: a root
    if (a != Sign::none) return a;
    if (b != Sign::none) return b;
    return point_sign(0.5 * (complex_.vertices[e.tail] + complex_.vertices[e.head]), density);
}

void Subspace::split_edges(int face, const LocalDensity& density) {
    const auto loop = complex_.faces[face].loop;
    for (const Step s : loop) {
        const int e = s >> 1;
        if (edge_signs_.at(e) != Sign::unknown) continue;
        const Sign sign = edge_sign(e, density);
        edge_signs_.set(e, sign);
        if (sign != Sign::unknown) continue;
        const int tail = complex_.edges[e].tail, head = complex_.edges[e].head;
        const Vec3 a = complex_.vertices[tail], b = complex_.vertices[head];
        const Vec3 root = root_between(density, a, density.at(a) - 0.5, b, density.at(b) - 0.5);
        const Vec3 x = on_seam(complex_.edges[e].faces, root, glm::length(b - a), density);
        const int middle = complex_.split_edge(e, x);
        vertex_signs_.set(middle, Sign::none);
        edge_signs_.set(e, vertex_signs_.at(tail));
        edge_signs_.set(int(complex_.edges.size()) - 1, vertex_signs_.at(head));
    }
}

// Sets loops_: the simple loops where faces of the cell inside and outside meet, counter-clockwise seen from inside.
void Subspace::find_loops(int cell) {
    loops_.clear();
    borders_.clear();
    for (const int f : complex_.cells[cell]) {
        if (face_labels_.at(f) != Sign::above) continue;
        const bool front = complex_.faces[f].front == cell;
        for (const Step s : complex_.faces[f].loop) {
            const int other = complex_.across(s >> 1, f, cell);
            if (face_labels_.at(other) == Sign::below) borders_.push_back({front ? s ^ 1 : s, other, f, false});
        }
    }
    for (Border& begin : borders_) {
        if (begin.used) continue;
        path_.clear();
        Border* at = &begin;
        while (at && !at->used) {
            at->used = true;
            path_.push_back(at);
            // Goes around the end of the step through faces outside to the next border.
            const int v = complex_.end(at->step);
            int f = at->outer, e = at->step >> 1;
            for (int turns = 0; turns < 10000; ++turns) {
                int next = -1;
                for (const Step s : complex_.faces[f].loop)
                    if (s >> 1 != e && (complex_.start(s) == v || complex_.end(s) == v)) next = s >> 1;
                e = next;
                const int beyond = complex_.across(e, f, cell);
                if (face_labels_.at(beyond) == Sign::above) break;
                f = beyond;
            }
            at = nullptr;
            for (Border& b : borders_)
                if (b.step >> 1 == e) at = &b;
            // A vertex that was met before closes a loop of its own.
            for (std::size_t k = 0; k < path_.size(); ++k) {
                if (complex_.start(path_[k]->step) != v) continue;
                Loop& loop = loops_.emplace_back();
                loop.seed = path_[k]->inner;
                for (std::size_t j = k; j < path_.size(); ++j) loop.steps.push_back(path_[j]->step);
                path_.resize(k);
                break;
            }
        }
    }
}

int Subspace::owner(int face, std::span<const int> family) const {
    for (const int c : family)
        if (complex_.faces[face].back == c || complex_.faces[face].front == c) return c;
    return family[0];
}

void Subspace::span(int cell, const LocalDensity& density) {
    find_loops(cell);
    walls_.clear();
    if (!loops_.empty())
        for (const int f : complex_.cells[cell]) {
            if (leaf_of_face_[f] >= 0) continue;
            const Vec3 area = complex_.area_vector(f);
            if (glm::length(area) <= 0) continue;
            const Vec3 n = glm::normalize(area) * (complex_.faces[f].front == cell ? -1.0 : 1.0);
            walls_.push_back({n, glm::dot(n, complex_.vertices[complex_.start(complex_.faces[f].loop[0])])});
        }
    CellComplex::List<4> family{cell};
    for (Loop& loop : loops_) {
        if (loop.steps.size() == 2) {  // two segments over one edge: a third vertex makes it a face
            const int e = loop.steps[0] >> 1;
            const Vec3 x = 0.5 * (complex_.vertices[complex_.start(2 * e)] + complex_.vertices[complex_.end(2 * e)]);
            complex_.split_edge(e, x);
            const int half = int(complex_.edges.size()) - 1;
            if (loop.steps[0] & 1)
                loop.steps = {2 * half + 1, 2 * e + 1, loop.steps[1]};
            else
                loop.steps = {2 * e, 2 * half, loop.steps[1]};
        }
        rim_.clear();
        points_.clear();
        for (const Step s : loop.steps) {
            rim_.push_back(complex_.start(s));
            points_.push_back(complex_.vertices[rim_.back()]);
        }
        span_loop(points_, density, walls_, complex_.tolerance, slack_in(cell), disc_);
        if (disc_.has_center) rim_.push_back(complex_.add_vertex(disc_.center));
        for (auto& face : disc_.faces)
            for (int& corner : face) corner = rim_[corner];
        const int fresh = complex_.split_cell(owner(loop.seed, family), loop.steps, loop.seed, disc_.faces);
        family.push_back(fresh);
        for (std::size_t f = leaf_of_face_.size(); f < complex_.faces.size(); ++f) face_labels_.set(int(f), Sign::none);
        leaf_of_face_.resize(complex_.faces.size(), leaf_);
        root_.push_back(root_[cell]);
        resolved_.push_back(resolved_[cell]);
        next_of_root_.push_back(next_of_root_[root_[cell]]);
        next_of_root_[root_[cell]] = fresh;
    }
    for (const int c : family) {
        Side side = Side::outside;
        for (const int f : complex_.cells[c])
            if (face_labels_.at(f) == Sign::above) side = Side::inside;
        resolved_[c].push_back({leaf_, side});
    }
}

}  // namespace deburr
