#include "polygonizer/triage/loop_disc.hpp"

#include <algorithm>
#include <numeric>

#include "polygonizer/triage/parallel_family.hpp"
#include "polygonizer/triage/subspace.hpp"

namespace deburr {
namespace {

// The least cosine between a flat rim and the surface at which the rim's plane is taken for the surface.
constexpr double least_cosine = 0.5;

Vec3 area_vector(const std::vector<Vec3>& rim) {
    Vec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < rim.size(); ++k) sum += glm::cross(rim[k] - rim[0], rim[k + 1] - rim[0]);
    return sum;
}

/// Whether the rim lies in the plane with this normal, within the tolerance.
bool is_flat(const std::vector<Vec3>& rim, Vec3 normal, double tolerance) {
    for (const Vec3& x : rim)
        if (std::abs(glm::dot(x - rim[0], normal)) > tolerance) return false;
    return true;
}

// Strips across a swept surface [Triage §4.5.2]. Its rulings run along `sweep`, so the loop is cut at every position
// along the profile where it has a vertex, from one end of the profile to the other. False if the loop runs back and
// forth along the profile.
bool strips(const std::vector<Vec3>& rim, Vec3 sweep, double tolerance, Disc& disc) {
    const int n = int(rim.size());
    // Position along the profile: perpendicular to the sweep, along the chord between the profile's ends.
    Vec3 chord(0.0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j) {
            const Vec3 d = rim[i] - rim[j];
            const Vec3 c = d - sweep * glm::dot(sweep, d);
            if (glm::length(c) > glm::length(chord)) chord = c;
        }
    if (glm::length(chord) <= 4 * tolerance) return false;
    chord = glm::normalize(chord);
    std::vector<double> u;
    for (const Vec3& x : rim) u.push_back(glm::dot(x, chord));
    const int low = int(std::min_element(u.begin(), u.end()) - u.begin());
    const int high = int(std::max_element(u.begin(), u.end()) - u.begin());
    const double slack = 4 * tolerance + 1e-9 * (u[high] - u[low]);
    // The two ways around the loop from a lowest vertex to a highest one.
    const auto walk = [&](int step, std::vector<int>& side) {
        for (int i = low;; i = (i + step + n) % n) {
            if (!side.empty() && u[i] < u[side.back()] - slack) return false;
            side.push_back(i);
            if (i == high) return true;
        }
    };
    std::vector<int> right, left;
    if (!walk(1, right) || !walk(-1, left)) return false;

    CellComplex::VertexList line{low};  // where the faces so far end, from left to right
    std::size_t i = 1, j = 1;           // the next vertices on the right and on the left
    const auto level = [&](int v) { return u[v]; };
    const double top = level(high) - slack;
    while (true) {
        const double r = level(right[i]), l = level(left[j]), here = level(line.front()) + slack;
        const bool ruling = level(line.back()) <= here && level(line.back()) >= here - 2 * slack;
        if (ruling && i + 1 < right.size() && r <= here) {
            line.push_back(right[i++]);
        } else if (ruling && j + 1 < left.size() && l <= here) {
            line.insert(line.begin(), left[j++]);
        } else if (r >= top && l >= top) {
            line.append(right.data() + i, right.data() + right.size());
            for (std::size_t k = left.size() - 1; k > j; --k) line.push_back(left[k - 1]);
            if (line.size() < 3) return false;
            disc.faces.push_back(line);
            return true;
        } else {
            const bool on_right = r <= l + slack, on_left = l <= r + slack;
            const CellComplex::VertexList next{on_left ? left[j] : line.front(), on_right ? right[i] : line.back()};
            if (on_right) line.push_back(right[i++]);
            if (on_left) line.push_back(left[j++]);
            if (line.size() > 2) disc.faces.push_back(line);
            line = next;
        }
    }
}

// Moves the rim's centroid along the gradient to the surface, within the walls; where the rim is in a plane that the
// surface does not follow, perpendicular to that plane. False if no surface is found.
bool displaced_centroid(const std::vector<Vec3>& rim, bool flat, const LocalDensity& density,
                        const std::vector<Wall>& walls, double tolerance, Vec3& center) {
    const Vec3 c = std::accumulate(rim.begin(), rim.end(), Vec3(0.0)) / double(rim.size());
    const ValueGradient here = density.gradient_at(c);
    const double f = here.value - 0.5;
    const double slope = glm::length(here.gradient);
    if (std::abs(f) < 1e-14 + tolerance * slope) {
        center = c;
        return true;
    }
    const Vec3 area = area_vector(rim);
    const double size = glm::length(area);
    Vec3 line = slope > 0 ? here.gradient / slope : Vec3(0.0);
    if (size > 0 && (flat || slope == 0) && glm::dot(area, line) < least_cosine * size) line = area / size;
    if (line == Vec3(0.0)) return false;
    if (f > 0) line = -line;
    double ahead = infinity, behind = -infinity;
    for (const Wall& w : walls) {
        const double gap = w.offset - glm::dot(w.normal, c), rate = glm::dot(w.normal, line);
        if (rate > 1e-12)
            ahead = std::min(ahead, gap / rate);
        else if (rate < -1e-12)
            behind = std::max(behind, gap / rate);
    }
    constexpr int samples = 8;
    for (const double reach : {ahead, behind}) {
        if (!std::isfinite(reach)) continue;
        Vec3 last = c;
        double flast = f;
        for (int k = 1; k <= samples; ++k) {
            const Vec3 x = c + line * (reach * k / samples);
            const double fx = density.at(x) - 0.5;
            if ((fx > 0) != (f > 0)) {
                center = root_between(density, last, flast, x, fx);
                return true;
            }
            last = x;
            flast = fx;
        }
    }
    return false;
}

// Whether the rim's plane faces as the surface does at the rim's middle.
bool follows(const std::vector<Vec3>& rim, const LocalDensity& density) {
    const Vec3 c = std::accumulate(rim.begin(), rim.end(), Vec3(0.0)) / double(rim.size());
    const Vec3 area = area_vector(rim), g = density.gradient_at(c).gradient;
    return glm::dot(area, g) >= least_cosine * glm::length(area) * glm::length(g);
}

// Whether the rim lies near a plane to which the surface at the rim's middle is near and nearly parallel.
bool is_nearly_flat(const std::vector<Vec3>& rim, Vec3 area, const LocalDensity& density, double slack) {
    const double size = glm::length(area);
    if (!(size > 0)) return false;
    constexpr double upright = 0.97;  // cosine
    const double near = std::min(slack, max_sag * std::sqrt(size));
    const Vec3 c = std::accumulate(rim.begin(), rim.end(), Vec3(0.0)) / double(rim.size()), normal = area / size;
    for (const Vec3& x : rim)
        if (std::abs(glm::dot(x - c, normal)) > near) return false;
    const ValueGradient here = density.gradient_at(c);
    const double slope = glm::length(here.gradient);
    return std::abs(here.value - 0.5) <= near * slope && glm::dot(normal, here.gradient) >= upright * slope;
}

// Spans the rim by the fan about that corner whose worst triangle leans least.
void fan_about_corner(const std::vector<Vec3>& rim, const LocalDensity& density, Disc& disc) {
    const int n = int(rim.size());
    int best = 0;
    double best_worst = -infinity;
    for (int apex = 0; apex < n; ++apex) {
        double worst = infinity;
        for (int k = 1; k + 1 < n; ++k) {
            const Vec3 a = rim[apex], b = rim[(apex + k) % n], c = rim[(apex + k + 1) % n];
            const Vec3 normal = glm::cross(b - a, c - a), g = density.gradient_at((a + b + c) / 3.0).gradient;
            const double size = glm::length(normal) * glm::length(g);
            worst = std::min(worst, size > 0 ? glm::dot(normal, g) / size : -1.0);
        }
        if (worst > best_worst) {
            best_worst = worst;
            best = apex;
        }
    }
    for (int k = 1; k + 1 < n; ++k) disc.faces.push_back({best, (best + k) % n, (best + k + 1) % n});
}

}  // namespace

void span_loop(const std::vector<Vec3>& rim, const LocalDensity& density, const std::vector<Wall>& walls,
               double tolerance, double slack, Disc& disc) {
    disc.faces.clear();
    disc.has_center = false;
    const int n = int(rim.size());
    const auto whole = [&] {
        auto& face = disc.faces.emplace_back();
        for (int k = 0; k < n; ++k) face.push_back(k);
    };
    if (n == 3 && follows(rim, density)) return whole();
    const Vec3 area = area_vector(rim);
    const bool flat = glm::length(area) > 0 && is_flat(rim, glm::normalize(area), tolerance);
    if (n > 3 && slack > 0 && is_nearly_flat(rim, area, density, slack)) return whole();
    Vec3 sweep;
    if (n > 3 && !(flat && !follows(rim, density)) && is_swept(density, sweep) && strips(rim, sweep, tolerance, disc))
        return;
    disc.faces.clear();
    if (!displaced_centroid(rim, flat, density, walls, tolerance, disc.center))
        return fan_about_corner(rim, density, disc);
    const Vec3 c = std::accumulate(rim.begin(), rim.end(), Vec3(0.0)) / double(n);
    if (flat && glm::length(disc.center - c) <= 2 * tolerance) return whole();
    disc.has_center = true;
    for (int k = 0; k < n; ++k) disc.faces.push_back({n, k, (k + 1) % n});
}

}  // namespace deburr
