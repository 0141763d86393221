#include "polygonizer/subspace.hpp"

#include <algorithm>
#include <cassert>

#include "polygonizer/disc.hpp"
#include "polygonizer/parallel_family.hpp"

namespace deburr {
namespace {

// |ρ − ½| below which a point is on the surface whatever the slope: rounding leaves 10⁻¹⁵, and
// where the slope is that of one half-space, ¾/r, it is a distance of 1.3·10⁻¹⁰ r.
constexpr double on_level = 1e-10;

}  // namespace

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
    for (const auto& [f, c] : to_split) split_face(f, c, density(c));
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
        const Vec3 x = root_between(density, a, density.at(a) - 0.5, b, density.at(b) - 0.5);
        const int middle = complex_.split_edge(e, x);
        vertex_sign_.resize(complex_.vertices.size(), Sign::unknown);
        vertex_sign_[std::size_t(middle)] = Sign::none;
        edge_sign_[std::size_t(e)] = vertex_sign_[std::size_t(tail)];
        edge_sign_.push_back(vertex_sign_[std::size_t(head)]);
    }
}

// Joins the places where the rim changes sign by segments [Triage §4.4.2].
void Subspace::split_face(int face, int cell, const LocalDensity& density) {
    const auto& loop = complex_.faces[std::size_t(face)].loop;
    const std::size_t n = loop.size();
    std::vector<Sign> signs;
    for (const Step s : loop) signs.push_back(edge_sign_[std::size_t(s >> 1)]);
    // An edge along the surface takes the sign before it.
    const auto first = std::find_if(signs.begin(), signs.end(), [](Sign s) { return s != Sign::none; });
    if (first == signs.end()) {
        Vec3 centroid(0.0);
        for (const Step s : loop) centroid += complex_.vertices[std::size_t(complex_.start(s))];
        const Sign sign = point_sign(centroid / double(n), density);
        return label(face, sign == Sign::above ? sign : Sign::below);
    }
    const std::size_t offset = std::size_t(first - signs.begin());
    std::vector<int> changes;  // vertices
    std::vector<Sign> after;   // of each change
    Sign current = *first;
    for (std::size_t k = 1; k <= n; ++k) {
        const std::size_t at = (offset + k) % n;
        if (signs[at] == Sign::none || signs[at] == current) continue;
        changes.push_back(complex_.start(loop[at]));
        current = signs[at];
        after.push_back(current);
    }
    if (changes.empty()) return label(face, current);

    Sign middle = Sign::unknown;
    if (changes.size() > 2) {
        Vec3 centroid(0.0);
        for (const int v : changes) centroid += complex_.vertices[std::size_t(v)];
        middle = point_sign(centroid / double(changes.size()), density);
        if (middle == Sign::none) middle = Sign::below;
    } else {
        middle = after[1];
    }
    label(face, middle);
    (void)cell;
    int rest = face;
    for (std::size_t k = 0; k < changes.size(); ++k) {
        if (after[k] == middle) continue;
        const int a = changes[k], b = changes[(k + 1) % changes.size()];
        if (a == b) continue;
        std::vector<Vec3> between;
        const bool bent = refine(rest, a, b, density, between);
        if (!bent) {
            // An arc of the rim that is as straight as the segment would leave a face of no area.
            const auto& l = complex_.faces[std::size_t(rest)].loop;
            const Vec3 xa = complex_.vertices[std::size_t(a)], d = complex_.vertices[std::size_t(b)] - xa;
            bool straight = true;
            std::size_t at = 0;
            while (complex_.start(l[at]) != a) at = (at + 1) % l.size();
            for (; complex_.start(l[at]) != b && straight; at = (at + 1) % l.size()) {
                const Vec3 x = complex_.vertices[std::size_t(complex_.start(l[at]))] - xa;
                straight = glm::length(glm::cross(x, d)) <= complex_.tolerance * glm::length(d);
            }
            if (straight) continue;
        }
        const int cut_off = complex_.split_face(rest, a, b, between);
        leaf_of_face_.resize(complex_.faces.size(), leaf_of_face_[std::size_t(rest)]);
        label(cut_off, after[k]);
        edge_sign_.resize(complex_.edges.size(), Sign::none);
        vertex_sign_.resize(complex_.vertices.size(), Sign::none);
    }
}

// A point of the surface near the segment's middle, in the face [Triage §4.4.3]; false if the
// segment is straight, or none is found.
bool Subspace::refine(int face, int a, int b, const LocalDensity& density, std::vector<Vec3>& between) {
    const Vec3 xa = complex_.vertices[std::size_t(a)], xb = complex_.vertices[std::size_t(b)];
    const Vec3 middle = 0.5 * (xa + xb);
    const double length = glm::length(xb - xa);
    const ValueGradient here = density.gradient_at(middle);
    const double f = here.value - 0.5;
    if (std::abs(f) <= on_level + 1e-7 * length * glm::length(here.gradient)) return false;
    const Vec3 area = complex_.area_vector(face);
    if (glm::length(area) <= 0) return false;
    const Vec3 normal = glm::normalize(area);
    // Along the gradient; in a swept surface up to a slide along it, so that every face that
    // crosses the sweep has its point at the same place of the profile.
    Vec3 line = here.gradient - normal * glm::dot(normal, here.gradient), sweep;
    if (is_swept(density, sweep) && std::abs(glm::dot(sweep, normal)) > 0.1)
        line = here.gradient - sweep * (glm::dot(normal, here.gradient) / glm::dot(normal, sweep));
    // Where the segment runs along the rim the gradient may lead out of the face: then across it.
    const Vec3 across = glm::cross(normal, xb - xa);
    for (const Vec3 direction : {line, across}) {
        if (glm::length(direction) <= 1e-9 * (direction == line ? glm::length(here.gradient) : length)) continue;
        Vec3 root;
        if (!search(face, middle, glm::normalize(direction) * (f > 0 ? -1.0 : 1.0), normal, length, density, root))
            continue;
        between.push_back(root);
        return true;
    }
    return false;
}

// The surface nearest to `middle` on a line in the face: ahead if it is there, else behind.
bool Subspace::search(int face, Vec3 middle, Vec3 line, Vec3 normal, double length,
                      const LocalDensity& density, Vec3& root) const {
    const double f = density.at(middle) - 0.5;
    double ahead = infinity, behind = -infinity;
    const Vec3 across = glm::cross(normal, line);
    for (const Step s : complex_.faces[std::size_t(face)].loop) {
        const Vec3 p = complex_.vertices[std::size_t(complex_.start(s))] - middle;
        const Vec3 q = complex_.vertices[std::size_t(complex_.end(s))] - middle;
        const double sp = glm::dot(across, p), sq = glm::dot(across, q);
        if ((sp < 0) == (sq < 0)) continue;
        const double t = glm::dot(line, p + (q - p) * (sp / (sp - sq)));
        if (t > 1e-9 * length) ahead = std::min(ahead, t);
        else if (t < -1e-9 * length) behind = std::max(behind, t);
    }
    constexpr int samples = 8;
    for (const double reach : {ahead, behind}) {
        if (!std::isfinite(reach)) continue;
        Vec3 last = middle;
        double flast = f;
        for (int k = 1; k <= samples; ++k) {
            const Vec3 x = middle + line * (reach * k / samples);
            const double fx = density.at(x) - 0.5;
            if ((fx > 0) == (f > 0)) {
                last = x;
                flast = fx;
                continue;
            }
            root = root_between(density, last, flast, x, fx);
            if (std::abs(reach - glm::dot(root - middle, line)) <= 1e-6 * length) break;  // on the rim
            return true;
        }
    }
    return false;
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
