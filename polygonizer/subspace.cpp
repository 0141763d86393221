#include "polygonizer/subspace.hpp"

#include <algorithm>

#include "polygonizer/disc.hpp"

namespace deburr {

Vec3 root_between(const LocalDensity& density, Vec3 a, double fa, Vec3 b, double fb) {
    // Regula falsi with interleaved bisection [Triage §4.4.1], as the Illinois method.
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

Subspace::Subspace(Subdivision& subdivision)
    : subdivision_(subdivision), complex_(subdivision.complex),
      leaf_of_face_(complex_.faces.size(), -1), resolved_(complex_.cells.size()) {
    for (std::size_t c = 0; c < complex_.cells.size(); ++c) origin_.push_back(int(c));
}

void Subspace::polygonize() {
    std::vector<int> leaves;
    for (std::size_t c = 0; c < complex_.cells.size(); ++c)
        for (const OpenLeaf& o : subdivision_.places[std::size_t(subdivision_.place_of[c])].open)
            leaves.push_back(o.leaf);
    std::sort(leaves.begin(), leaves.end());
    leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
    for (const int leaf : leaves) cut_by(leaf);
}

Side Subspace::side(int cell, int leaf) const {
    if (cell == CellComplex::outside) return Side::straddling;
    for (const auto& [l, side] : resolved_[std::size_t(cell)])
        if (l == leaf) return side;
    return subdivision_.side(cell, leaf);
}

bool Subspace::inside(int cell) const {
    if (cell == CellComplex::outside) return false;
    const Place& place = subdivision_.places[std::size_t(subdivision_.place_of[std::size_t(cell)])];
    if (place.side != Side::straddling) return place.side == Side::inside;
    std::vector<char> in;
    for (const SolidTreeNode& n : place.solid) {
        const auto at = [&](int child) { return bool(in[std::size_t(child)]); };
        switch (n.op) {
            case SolidOp::nothing: in.push_back(false); break;
            case SolidOp::everything: in.push_back(true); break;
            case SolidOp::leaf: in.push_back(side(cell, n.a) == Side::inside); break;
            case SolidOp::unite: in.push_back(at(n.a) || at(n.b)); break;
            case SolidOp::intersect: in.push_back(at(n.a) && at(n.b)); break;
            case SolidOp::subtract: in.push_back(at(n.a) && !at(n.b)); break;
        }
    }
    return in.back();
}

void Subspace::label(int face, Sign sign) {
    face_label_.resize(complex_.faces.size(), Sign::unknown);
    face_label_[std::size_t(face)] = sign;
}

void Subspace::cut_by(int leaf) {
    leaf_ = leaf;
    vertex_sign_.assign(complex_.vertices.size(), Sign::unknown);
    edge_sign_.assign(complex_.edges.size(), Sign::unknown);
    face_label_.assign(complex_.faces.size(), Sign::unknown);
    std::vector<int> open;
    for (std::size_t c = 0; c < complex_.cells.size(); ++c)
        if (subdivision_.open(int(c), leaf)) open.push_back(int(c));

    std::vector<std::pair<int, int>> to_split;  // face, open cell
    for (const int c : open)
        for (const int f : complex_.cells[std::size_t(c)]) {
            if (label_of(f) != Sign::unknown) continue;
            const Side beyond = side(complex_.neighbour(f, c), leaf);
            if (beyond == Side::straddling) {
                label(f, Sign::none);
                to_split.push_back({f, c});
            } else {
                label(f, beyond == Side::inside ? Sign::above : Sign::below);
            }
        }
    const auto density = [&](int cell) -> const LocalDensity& {
        return *subdivision_.open(cell, leaf)->density;
    };
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
    vertex_sign_.resize(complex_.vertices.size(), Sign::unknown);
    Sign& sign = vertex_sign_[std::size_t(vertex)];
    if (sign == Sign::unknown) sign = point_sign(complex_.vertices[std::size_t(vertex)], density);
    return sign;
}

// What cells say of an edge holds; only where all around it are undecided its ends are asked.
Subspace::Sign Subspace::edge_sign(int edge, const LocalDensity& density) {
    bool in = false, out = false;
    const auto& e = complex_.edges[std::size_t(edge)];
    for (const int f : e.faces)
        for (const int c : {complex_.faces[std::size_t(f)].back, complex_.faces[std::size_t(f)].front}) {
            const Side s = side(c, leaf_);
            in |= s == Side::inside;
            out |= s == Side::outside;
        }
    if (in || out) return in && out ? Sign::none : in ? Sign::above : Sign::below;
    const Sign a = vertex_sign(e.tail, density), b = vertex_sign(e.head, density);
    if (a != Sign::none && b != Sign::none) return a == b ? a : Sign::unknown;  // unknown: a root
    if (a != Sign::none) return a;
    if (b != Sign::none) return b;
    return point_sign(0.5 * (complex_.vertices[std::size_t(e.tail)] + complex_.vertices[std::size_t(e.head)]),
                      density);
}

void Subspace::split_edges(int face, const LocalDensity& density) {
    const std::vector<Step> loop = complex_.faces[std::size_t(face)].loop;
    for (const Step s : loop) {
        const int e = s >> 1;
        edge_sign_.resize(complex_.edges.size(), Sign::unknown);
        if (edge_sign_[std::size_t(e)] != Sign::unknown) continue;
        const Sign sign = edge_sign(e, density);
        edge_sign_[std::size_t(e)] = sign;
        if (sign != Sign::unknown) continue;
        const int tail = complex_.edges[std::size_t(e)].tail, head = complex_.edges[std::size_t(e)].head;
        const Vec3 a = complex_.vertices[std::size_t(tail)], b = complex_.vertices[std::size_t(head)];
        const Vec3 root = root_between(density, a, density.at(a) - 0.5, b, density.at(b) - 0.5);
        const Vec3 x = on_seam(complex_.edges[std::size_t(e)].faces, root, glm::length(b - a), density);
        const int middle = complex_.split_edge(e, x);
        vertex_sign_.resize(complex_.vertices.size(), Sign::unknown);
        vertex_sign_[std::size_t(middle)] = Sign::none;
        edge_sign_[std::size_t(e)] = vertex_sign_[std::size_t(tail)];
        edge_sign_.push_back(vertex_sign_[std::size_t(head)]);
    }
}

// Loops where faces of the cell inside and outside meet, simple, counter-clockwise seen from inside.
std::vector<Subspace::Loop> Subspace::loops(int cell) {
    struct Border {
        Step step;
        int outer, inner;  // faces
        bool used;
    };
    std::vector<Border> borders;
    for (const int f : complex_.cells[std::size_t(cell)]) {
        if (label_of(f) != Sign::above) continue;
        const bool front = complex_.faces[std::size_t(f)].front == cell;
        for (const Step s : complex_.faces[std::size_t(f)].loop) {
            const int other = complex_.across(s >> 1, f, cell);
            if (label_of(other) == Sign::below) borders.push_back({front ? s ^ 1 : s, other, f, false});
        }
    }
    std::vector<Loop> result;
    for (Border& begin : borders) {
        if (begin.used) continue;
        std::vector<Border*> path;
        Border* at = &begin;
        while (at && !at->used) {
            at->used = true;
            path.push_back(at);
            // Around the end of the step through faces outside, to the next border.
            const int v = complex_.end(at->step);
            int f = at->outer, e = at->step >> 1;
            for (int turns = 0; turns < 10000; ++turns) {
                int next = -1;
                for (const Step s : complex_.faces[std::size_t(f)].loop)
                    if (s >> 1 != e && (complex_.start(s) == v || complex_.end(s) == v)) next = s >> 1;
                e = next;
                const int beyond = complex_.across(e, f, cell);
                if (label_of(beyond) == Sign::above) break;
                f = beyond;
            }
            at = nullptr;
            for (Border& b : borders)
                if (b.step >> 1 == e) at = &b;
            // A vertex seen before closes a loop of its own.
            for (std::size_t k = 0; k < path.size(); ++k) {
                if (complex_.start(path[k]->step) != v) continue;
                Loop loop{{}, path[k]->inner};
                for (std::size_t j = k; j < path.size(); ++j) loop.steps.push_back(path[j]->step);
                result.push_back(std::move(loop));
                path.resize(k);
                break;
            }
        }
    }
    return result;
}

int Subspace::owner(int face, const std::vector<int>& family) const {
    for (const int c : family)
        if (complex_.faces[std::size_t(face)].back == c || complex_.faces[std::size_t(face)].front == c)
            return c;
    return family[0];
}

void Subspace::span(int cell, const LocalDensity& density) {
    const std::vector<int> own = complex_.cells[std::size_t(cell)];
    std::vector<Wall> walls;
    for (const int f : own) {
        if (leaf_of_face_[std::size_t(f)] >= 0) continue;
        const Vec3 area = complex_.area_vector(f);
        if (glm::length(area) <= 0) continue;
        const Vec3 n = glm::normalize(area) * (complex_.faces[std::size_t(f)].front == cell ? -1.0 : 1.0);
        walls.push_back({n, glm::dot(n, complex_.vertices[std::size_t(
                                           complex_.start(complex_.faces[std::size_t(f)].loop[0]))])});
    }
    std::vector<int> family{cell};
    for (Loop& loop : loops(cell)) {
        if (loop.steps.size() == 2) {  // two segments over one edge: a third vertex makes it a face
            const int e = loop.steps[0] >> 1;
            const Vec3 x = 0.5 * (complex_.vertices[std::size_t(complex_.start(2 * e))] +
                                  complex_.vertices[std::size_t(complex_.end(2 * e))]);
            complex_.split_edge(e, x);
            const int half = int(complex_.edges.size()) - 1;
            if (loop.steps[0] & 1) loop.steps = {2 * half + 1, 2 * e + 1, loop.steps[1]};
            else loop.steps = {2 * e, 2 * half, loop.steps[1]};
        }
        std::vector<int> rim;
        std::vector<Vec3> points;
        for (const Step s : loop.steps) {
            rim.push_back(complex_.start(s));
            points.push_back(complex_.vertices[std::size_t(rim.back())]);
        }
        const Disc disc = span_loop(points, density, walls, complex_.tolerance);
        if (disc.has_centre) rim.push_back(complex_.add_vertex(disc.centre));
        std::vector<std::vector<int>> faces;
        for (const auto& face : disc.faces) {
            faces.emplace_back();
            for (const int k : face) faces.back().push_back(rim[std::size_t(k)]);
        }
        const int fresh = complex_.split_cell(owner(loop.seed, family), loop.steps, loop.seed, faces);
        family.push_back(fresh);
        leaf_of_face_.resize(complex_.faces.size(), leaf_);
        face_label_.resize(complex_.faces.size(), Sign::none);
        subdivision_.place_of.push_back(subdivision_.place_of[std::size_t(cell)]);
        origin_.push_back(origin_[std::size_t(cell)]);
        resolved_.push_back(resolved_[std::size_t(cell)]);
    }
    for (const int c : family) {
        Side side = Side::outside;
        for (const int f : complex_.cells[std::size_t(c)])
            if (label_of(f) == Sign::above) side = Side::inside;
        resolved_[std::size_t(c)].push_back({leaf_, side});
    }
}

}  // namespace deburr
