// Cuts the faces between cells by the isosurface: by segments, and by the points that refine them.
#include <algorithm>

#include "polygonizer/triage/parallel_family.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {

// Joins the points where the sign changes along the face's border by segments [Triage §4.4.2].
void Subspace::split_face(int face, const LocalDensity& density) {
    const Sign last = find_sign_changes(face);
    if (changes_.empty())
        return face_labels_.set(face, last == Sign::none ? centroid_sign(complex_.corners(face), density) : last);
    const Sign middle = changes_.size() > 2 ? centroid_sign(changes_, density) : after_[1];
    face_labels_.set(face, middle);
    for (std::size_t k = 0; k < changes_.size(); ++k) {
        const int a = changes_[k], b = changes_[(k + 1) % changes_.size()];
        if (after_[k] != middle && a != b) cut_off(face, a, b, after_[k], density);
    }
}

// Lists the vertices where the sign changes along the face's border in changes_, and the sign after each in after_. An
// edge along the surface takes the sign of the edge before it. Returns the last sign; none if all edges are along it.
Subspace::Sign Subspace::find_sign_changes(int face) {
    const auto& loop = complex_.faces[face].loop;
    const std::size_t n = loop.size();
    rim_signs_.clear();
    changes_.clear();
    after_.clear();
    for (const Step s : loop) rim_signs_.push_back(edge_signs_.at(s >> 1));
    const auto first = std::find_if(rim_signs_.begin(), rim_signs_.end(), [](Sign s) { return s != Sign::none; });
    if (first == rim_signs_.end()) return Sign::none;
    const std::size_t offset = std::size_t(first - rim_signs_.begin());
    Sign current = *first;
    for (std::size_t k = 1; k <= n; ++k) {
        const std::size_t at = (offset + k) % n;
        if (rim_signs_[at] == Sign::none || rim_signs_[at] == current) continue;
        changes_.push_back(complex_.start(loop[at]));
        current = rim_signs_[at];
        after_.push_back(current);
    }
    return current;
}

// The sign at the vertices' centroid; below if that is on the surface.
Subspace::Sign Subspace::centroid_sign(std::span<const int> vertices, const LocalDensity& density) const {
    Vec3 centroid(0.0);
    for (const int v : vertices) centroid += complex_.vertices[v];
    const Sign sign = point_sign(centroid / double(vertices.size()), density);
    return sign == Sign::none ? Sign::below : sign;
}

// Splits the face by the refined segment from vertex a to vertex b of its border. The new face, with the border from a
// to b, gets the sign. Does nothing if that face would have no area.
void Subspace::cut_off(int face, int a, int b, Sign sign, const LocalDensity& density) {
    const std::optional<Vec3> between = refine(face, a, b, density);
    if (!between && is_straight_border(face, a, b)) return;
    const std::size_t edges = complex_.edges.size(), vertices = complex_.vertices.size();
    const int new_face = between ? complex_.split_face(face, a, b, {&*between, 1}) : complex_.split_face(face, a, b);
    leaf_of_face_.resize(complex_.faces.size(), leaf_of_face_[face]);
    face_labels_.set(new_face, sign);
    for (std::size_t e = edges; e < complex_.edges.size(); ++e) edge_signs_.set(int(e), Sign::none);
    for (std::size_t v = vertices; v < complex_.vertices.size(); ++v) vertex_signs_.set(int(v), Sign::none);
}

// Whether the face's border from vertex a to vertex b is as straight as the segment between them.
bool Subspace::is_straight_border(int face, int a, int b) const {
    const auto& loop = complex_.faces[face].loop;
    const Vec3 xa = complex_.vertices[a], d = complex_.vertices[b] - xa;
    std::size_t at = 0;
    while (complex_.start(loop[at]) != a) at = (at + 1) % loop.size();
    for (; complex_.start(loop[at]) != b; at = (at + 1) % loop.size()) {
        const Vec3 x = complex_.vertices[complex_.start(loop[at])] - xa;
        if (!(glm::length(glm::cross(x, d)) <= complex_.tolerance * glm::length(d))) return false;
    }
    return true;
}

// A point of the surface in the face, near the segment's middle [Triage §4.4.3]; none if the segment is straight
// enough, or if no such point is found.
std::optional<Vec3> Subspace::refine(int face, int a, int b, const LocalDensity& density) const {
    const Vec3 xa = complex_.vertices[a], xb = complex_.vertices[b];
    const Vec3 middle = 0.5 * (xa + xb);
    const double length = glm::length(xb - xa);
    const ValueGradient here = density.gradient_at(middle);
    const double f = here.value - 0.5;
    const double slope = glm::length(here.gradient);
    if (std::abs(f) <= on_level + 1e-7 * length * slope) return {};
    const double slack = std::min(slack_in(complex_.faces[face].back), slack_in(complex_.faces[face].front));
    if (std::abs(f) <= std::min(slack, max_sag * length) * slope) return {};
    const Vec3 area = complex_.area_vector(face);
    if (glm::length(area) <= 0) return {};
    const Vec3 normal = glm::normalize(area);
    // The search runs along the gradient; in a swept surface it is shifted along the sweep, so that all faces that
    // cross the sweep have their points at the same position of the profile.
    Vec3 line = here.gradient - normal * glm::dot(normal, here.gradient), sweep;
    if (is_swept(density, sweep) && std::abs(glm::dot(sweep, normal)) > 0.1)
        line = here.gradient - sweep * (glm::dot(normal, here.gradient) / glm::dot(normal, sweep));
    // If the segment runs along the face's border, the gradient may lead out of the face; then the search runs across
    // the segment.
    const Vec3 across = glm::cross(normal, xb - xa);
    for (const Vec3 direction : {line, across}) {
        if (glm::length(direction) <= 1e-9 * (direction == line ? slope : length)) continue;
        Vec3 root;
        if (!search(face, middle, glm::normalize(direction) * (f > 0 ? -1.0 : 1.0), normal, length, density, root))
            continue;
        return on_seam({&face, 1}, root, length, density);
    }
    return {};
}

// Moves a point of this leaf's surface on faces of earlier leaves' surfaces to where the surfaces meet, because such
// faces are flat and only near their surfaces. Faces on planes keep the point in their planes. The point stays where it
// is if it would move farther than `reach`.
Vec3 Subspace::on_seam(std::span<const int> faces, Vec3 start, double reach, const LocalDensity& density) const {
    const bool seam = std::any_of(faces.begin(), faces.end(),
                                  [&](int f) { return leaf_of_face_[f] >= 0 && leaf_of_face_[f] != leaf_; });
    if (!seam) return start;
    std::vector<const LocalDensity*> surfaces{&density};
    std::vector<Vec3> planes;
    for (const int f : faces) {
        const int leaf = leaf_of_face_[f];
        if (leaf < 0) {
            const Vec3 area = complex_.area_vector(f);
            if (glm::length(area) <= 0) continue;
            const Vec3 n = glm::normalize(area);
            const bool known = std::any_of(planes.begin(), planes.end(), [&](Vec3 p) {
                constexpr double parallel = 1e-6;  // sine
                return glm::length(glm::cross(p, n)) < parallel;
            });
            if (!known) planes.push_back(n);
            continue;
        }
        const int cell = complex_.faces[f].back;
        const OpenLeaf* open = leaf == leaf_ ? nullptr : this->open(cell, leaf);
        if (open && std::find(surfaces.begin(), surfaces.end(), open->density.get()) == surfaces.end())
            surfaces.push_back(open->density.get());
    }
    const std::size_t count = surfaces.size() + planes.size();
    if (surfaces.size() < 2 || count > 3) return start;
    Vec3 x = start;
    constexpr int steps = 20;  // Newton steps; 4 are usually enough
    for (int step = 0; step < steps; ++step) {
        Vec3 rows[3] = {Vec3(0.0), Vec3(0.0), Vec3(0.0)}, right(0.0);
        std::size_t k = 0;
        for (const LocalDensity* surface : surfaces) {
            const ValueGradient v = surface->gradient_at(x);
            const double slope = glm::length(v.gradient);
            if (!(slope > 0)) return start;
            rows[k] = v.gradient / slope;
            right[int(k)] = (0.5 - v.value) / slope;
            ++k;
        }
        for (const Vec3& n : planes) {
            rows[k] = n;
            right[int(k)] = glm::dot(n, start - x);
            ++k;
        }
        if (k == 2) rows[2] = glm::cross(rows[0], rows[1]);  // makes the step the shortest one
        const double size = std::abs(glm::determinant(Mat3(rows[0], rows[1], rows[2])));
        constexpr double tangent = 1e-4;  // surfaces at a smaller angle touch rather than cross
        if (size < tangent) return start;
        const Vec3 move = glm::inverse(glm::transpose(Mat3(rows[0], rows[1], rows[2]))) * right;
        x += move;
        if (!(glm::length(x - start) <= reach)) return start;
        if (glm::length(move) <= 1e-3 * complex_.tolerance) break;
    }
    return x;
}

// Finds the surface nearest to `middle` on a line in the face: ahead if it is there, else behind; false if there is
// none.
bool Subspace::search(int face, Vec3 middle, Vec3 line, Vec3 normal, double length, const LocalDensity& density,
                      Vec3& root) const {
    const double f = density.at(middle) - 0.5;
    double ahead = infinity, behind = -infinity;
    const Vec3 across = glm::cross(normal, line);
    for (const Step s : complex_.faces[face].loop) {
        const Vec3 p = complex_.vertices[complex_.start(s)] - middle;
        const Vec3 q = complex_.vertices[complex_.end(s)] - middle;
        const double sp = glm::dot(across, p), sq = glm::dot(across, q);
        if ((sp < 0) == (sq < 0)) continue;
        const double t = glm::dot(line, p + (q - p) * (sp / (sp - sq)));
        if (t > 1e-9 * length)
            ahead = std::min(ahead, t);
        else if (t < -1e-9 * length)
            behind = std::max(behind, t);
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
            if (std::abs(reach - glm::dot(root - middle, line)) <= 1e-6 * length) break;  // on the face's border
            return true;
        }
    }
    return false;
}

}  // namespace deburr
