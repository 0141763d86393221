// Let R be the part of the unit ball where the function is true, and wₚ at a point of plane p the
// function's value on p's inner side less that on its outer side: −1, 0 or 1. By the divergence
// theorem
//
//     3 vol(R) = Σₚ tₚ Aₚ + S,    Aₚ = ∫ wₚ over p's disc,    S the area of the unit sphere in R.
//
// The same once more in p's disc, whose radius is ρₚ: with the second difference wₚq of the
// function across the chord that q cuts, at the distance d in the disc,
//
//     2 Aₚ = ρₚ² Θₚ + Σ d · ∫ wₚq along the chord,    Θₚ = ∫ wₚ dθ around the disc.
//
// On the sphere take a pole a, the height z = a·y and the longitude φ about it. (1 − z) dφ has the
// surface's element as its derivative but for the antipole −a, where it misses 4π. Around p's circle,
//
//     (1 − z) dφ = (−tₚ + (tₚ + a·nₚ)/(1 + z)) dθ,    1 + z = 1 + tₚ a·nₚ + ρₚσₚ cos θ,
//
// θ counted from where z is greatest, σₚ the length of a along p. The second term is ±dψ, where
// tan(ψ/2) = √((1 + z_least)/(1 + z_most)) tan(θ/2): ψ is the angle that a stereographic projection
// from the antipole makes of θ. As (1 + z_least)(1 + z_most) = (tₚ + a·nₚ)²,
//
//     S = Σₚ tₚ Θₚ − sign(tₚ + a·nₚ) Ψₚ  +  4π·function(−a),    Ψₚ = ∫ wₚ dψ.
//
// Circles are oriented about their normals, which has the inner side to the right: hence the signs.
// For one plane, Aₚ = π(1 − t²) and S = 2π(1 + t), this is the cubic [Lobb eq. 2].
#include "bounds/ball_arrangement.hpp"

#include <algorithm>
#include <numbers>

namespace deburr {
namespace {

constexpr double pi = std::numbers::pi;

// Where the pole may be: the antipole should keep clear of every plane, for ψ turns fast near it.
constexpr double clear_enough = 0.1;
constexpr int max_poles = 24;

// Points that are spread evenly and lie on nobody's grid: a Fibonacci lattice.
Vec3 pole(int k) {
    const double z = 1 - (2 * k + 1.0) / max_poles, phi = 0.4142 + 2.399963229728653 * (7 * k % max_poles);
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}

}  // namespace

// Chooses the pole and gives every circle its axes; what the antipole adds comes later.
void BallArrangement::arrange(const std::vector<BallPlane>& planes, TruthTable& table) {
    static const std::vector<Vec3> poles = [] {
        std::vector<Vec3> all;
        for (int k = 0; k < max_poles; ++k) all.push_back(pole(k));
        return all;
    }();
    Vec3 a{0, 0, 1};
    double best = -1;
    for (const Vec3& candidate : poles) {
        double clearance = 2;
        for (const BallPlane& p : planes)
            clearance = std::min(clearance, std::abs(p.t + glm::dot(p.normal, candidate)));
        if (clearance <= best) continue;
        best = clearance;
        a = candidate;
        if (best >= clear_enough) break;
    }
    circles_.clear();
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const auto& [n, t] = planes[p];
        const double up = glm::dot(n, a);
        Circle c;
        c.u = a - up * n;
        double sigma = glm::length(c.u);
        if (sigma < 1e-9) {  // ψ = θ, wherever it is counted from
            const Vec3 other = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
            c.u = other - glm::dot(other, n) * n;
            c.u /= glm::length(c.u);
            sigma = 0;
        } else {
            c.u /= sigma;
        }
        c.v = glm::cross(n, c.u);
        c.radius = std::sqrt((1 - t) * (1 + t));
        c.near = std::abs(t + up);
        c.far = 1 + t * up + c.radius * sigma;
        c.side = t + up >= 0 ? 1 : -1;
        circles_.push_back(c);
        table.put(int(p), t + up >= 0);
    }
}

// Every two planes' common chord, found once for both: what rounding does to it must be the same
// for either, as it may be much where they are nearly parallel.
void BallArrangement::join(const std::vector<BallPlane>& planes) {
    count_ = planes.size();
    chords_.assign(count_ * count_, {});
    for (std::size_t p = 0; p < count_; ++p)
        for (std::size_t q = p + 1; q < count_; ++q) {
            Chord &of_p = chord(p, q), &of_q = chord(q, p);
            const Vec3 across = glm::cross(planes[p].normal, planes[q].normal);
            const double s = glm::length(across), c = glm::dot(planes[p].normal, planes[q].normal);
            const double apart = planes[q].t - c * planes[p].t;  // s times the distance in p's disc
            // As d lies beyond the disc, either disc lies on one side of the other's plane.
            if (std::abs(apart) >= s * circles_[p].radius) {
                of_p.d = apart;
                of_q.d = planes[p].t - c * planes[q].t;
                continue;
            }
            const Vec3 e = across / s;
            const double d = apart / s;
            of_p.d = d;
            of_q.d = s * planes[p].t - c * d;
            of_p.half = of_q.half = std::sqrt((circles_[p].radius - d) * (circles_[p].radius + d));
            const Vec3 in_p = glm::cross(e, planes[p].normal), in_q = glm::cross(planes[q].normal, e);
            of_p.mx = glm::dot(in_p, circles_[p].u);
            of_p.my = glm::dot(in_p, circles_[p].v);
            of_q.mx = glm::dot(in_q, circles_[q].u);
            of_q.my = glm::dot(in_q, circles_[q].v);
        }
}

int BallArrangement::weight(std::size_t p, TruthTable& table) const {
    table.put(int(p), true);
    const int in = table.value();
    table.flip(int(p));
    return in - int(table.value());
}

// Around p's circle: returns Θₚ and adds p's part of S.
double BallArrangement::arcs(const std::vector<BallPlane>& planes, std::size_t p, TruthTable& table, double& sphere) {
    const Circle& c = circles_[p];
    events_.clear();
    for (std::size_t q = 0; q < count_; ++q) {
        if (q == p) continue;
        const Chord& ch = chord(p, q);
        if (ch.half == 0) {
            table.put(int(q), ch.d >= 0);
            continue;
        }
        // Outside q from phi − beta to phi + beta.
        const double phi = std::atan2(ch.my, ch.mx), beta = std::atan2(ch.half, ch.d);
        double from = phi - beta, to = phi + beta;
        bool inside = true;  // at −π
        if (from < -pi) {
            from += 2 * pi;
            inside = false;
        }
        if (to >= pi) {
            to -= 2 * pi;
            inside = false;
        }
        table.put(int(q), inside);
        events_.push_back({from, int(q)});
        events_.push_back({to, int(q)});
    }
    std::sort(events_.begin(), events_.end());
    // Σ w (x_end − x_start) over the arcs is Σ x (w_before − w_after) over their ends.
    int before = weight(p, table);
    double theta = 0, psi = 0;
    const auto end = [&](double at, double of_psi, int change) {
        theta += at * change;
        psi += of_psi * change;
    };
    end(-pi, -pi, -before);
    for (const Event& e : events_) {
        table.flip(e.variable);
        const int after = weight(p, table);
        if (after == before) continue;
        const double half = 0.5 * e.at;
        end(e.at, 2 * std::atan2(c.near * std::sin(half), c.far * std::cos(half)), before - after);
        before = after;
    }
    end(pi, pi, before);
    sphere += planes[p].t * theta - c.side * psi;
    return theta;
}

// Over the chords in p's disc: Σ d · ∫ wₚq. Chords that lie on one line are crossed as one.
double BallArrangement::chords(std::size_t p, TruthTable& table) {
    double sum = 0;
    done_.assign(count_, false);
    done_[p] = true;
    for (std::size_t q = 0; q < count_; ++q) {
        const Chord& ch = chord(p, q);
        if (done_[q] || ch.half == 0) continue;
        line_.clear();
        events_.clear();
        for (std::size_t r = 0; r < count_; ++r) {
            if (r == p) continue;
            const Chord& other = chord(p, r);
            if (other.half == 0) {
                table.put(int(r), other.d >= 0);
                continue;
            }
            const double along = other.my * ch.mx - other.mx * ch.my;  // m of r along the chord
            const double across = other.mx * ch.mx + other.my * ch.my;
            const double room = other.d - ch.d * across;
            if (r == q || (!done_[r] && std::abs(along) <= one_plane && std::abs(room) <= one_plane)) {
                line_.push_back(r);
                table.put(int(r), across > 0);
                continue;
            }
            // Inside where along · y ≤ room.
            if (std::abs(room) >= std::abs(along) * ch.half) {
                table.put(int(r), room >= 0);
                continue;
            }
            table.put(int(r), along > 0);
            events_.push_back({room / along, int(r)});
        }
        for (const std::size_t r : line_) done_[r] = true;
        std::sort(events_.begin(), events_.end());
        const auto step = [&] {  // wₚ on the inner side of the line, less that on its outer side
            const int in = weight(p, table);
            for (const std::size_t r : line_) table.flip(int(r));
            const int out = weight(p, table);
            for (const std::size_t r : line_) table.flip(int(r));
            return in - out;
        };
        int before = step();
        double length = -ch.half * -before;
        for (const Event& e : events_) {
            table.flip(e.variable);
            const int after = step();
            length += e.at * (before - after);
            before = after;
        }
        length += ch.half * before;
        sum += ch.d * length;
    }
    return sum;
}

double BallArrangement::measure(const std::vector<BallPlane>& planes, TruthTable& table, std::vector<double>& areas) {
    arrange(planes, table);
    double sphere = table.value() ? 4 * pi : 0;
    join(planes);
    areas.assign(count_, 0);
    double sum = 0;
    for (std::size_t p = 0; p < count_; ++p) {
        const double theta = arcs(planes, p, table, sphere);
        const double radius = circles_[p].radius;
        areas[p] = 0.5 * (radius * radius * theta + chords(p, table));
        sum += planes[p].t * areas[p];
    }
    return std::clamp((sum + sphere) / (4 * pi), 0.0, 1.0);
}

}  // namespace deburr
