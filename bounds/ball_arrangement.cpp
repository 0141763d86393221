// Volume and areas of the part R of the unit ball where a Boolean function of planes is true. At a point of plane p let
// wₚ be the function's value on p's inner side less that on its outer side: −1, 0 or 1. By the divergence theorem
//
//     3 vol(R) = Σₚ tₚ Aₚ + S,    Aₚ = ∫ wₚ over p's disc,    S the area of the unit sphere in R.
//
// The same theorem in p's disc, whose radius is ρₚ, gives Aₚ. With wₚq the second difference of the function across the
// chord that q cuts, at the distance d from the disc's centre,
//
//     2 Aₚ = ρₚ² Θₚ + Σ d · ∫ wₚq along the chord,    Θₚ = ∫ wₚ dθ around the disc.
//
// On the sphere take a pole a, the height z = a·y and the longitude φ about a. The form (1 − z) dφ has the surface
// element as its exterior derivative except at the antipole −a, which contributes 4π. Around p's circle,
//
//     (1 − z) dφ = (−tₚ + (tₚ + a·nₚ)/(1 + z)) dθ,    1 + z = 1 + tₚ a·nₚ + ρₚσₚ cos θ,
//
// with θ counted from where z is greatest, and σₚ the length of the component of a along p. The second term is ±dψ,
// where tan(ψ/2) = √((1 + z_least)/(1 + z_most)) tan(θ/2): ψ is θ under the stereographic projection from the antipole.
// As (1 + z_least)(1 + z_most) = (tₚ + a·nₚ)²,
//
//     S = Σₚ tₚ Θₚ − sign(tₚ + a·nₚ) Ψₚ  +  4π·function(−a),    Ψₚ = ∫ wₚ dψ.
//
// Circles are oriented counter-clockwise about their normals, so the inner side is to the right: hence the signs. For
// one plane, Aₚ = π(1 − t²) and S = 2π(1 + t), which gives the cubic [Lobb eq. 2].
//
// The integrals of wₚ and wₚq are signed lengths of the parts of a circle or chord on which the function is true with p
// (and q) taken to be true, and taken to be false. A circle or chord is sent through the function's steps as an
// interval: a plane that cuts it splits it, and each part goes its own way; where a step asks for p, one copy continues
// with p true, and another, of opposite sign, with p false. A part whose evaluation ends before p (and q) is asked for
// adds nothing, as the function does not depend on them there; so most parts are short and end soon.
#include "bounds/ball_arrangement.hpp"

#include <algorithm>

namespace deburr {
namespace {

// The pole is good enough if the antipole is at this distance from every plane, because ψ turns fast near a plane.
constexpr double clear_enough = 0.1;
constexpr int max_poles = 24;

// The k-th candidate pole: points of a Fibonacci lattice, which are spread evenly and not on any model's grid.
Vec3 pole(int k) {
    const double z = 1 - (2 * k + 1.0) / max_poles, phi = 0.4142 + 2.399963229728653 * (7 * k % max_poles);
    const double s = std::sqrt(1 - z * z);
    return {s * std::cos(phi), s * std::sin(phi), z};
}

}  // namespace

// Chooses the pole and gives every circle its axes.
void BallArrangement::choose_pole(const std::vector<BallPlane>& planes) {
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
        if (sigma < 1e-9) {  // ψ = θ, whatever θ is counted from
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
    }
}

// Finds the common chord of every two planes, once for both: its rounding error must be the same for either, as it may
// be large where they are nearly parallel.
void BallArrangement::find_chords(const std::vector<BallPlane>& planes) {
    chords_.assign(count_ * count_, {});
    for (std::size_t p = 0; p < count_; ++p)
        for (std::size_t q = p + 1; q < count_; ++q) {
            Chord &of_p = chord(p, q), &of_q = chord(q, p);
            const Vec3 across = glm::cross(planes[p].normal, planes[q].normal);
            const double s = glm::length(across), c = glm::dot(planes[p].normal, planes[q].normal);
            const double apart = planes[q].t - c * planes[p].t;  // s times the distance in p's disc
            // If d lies beyond the disc, each disc lies on one side of the other's plane.
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

/// The last step that asks for each plane.
void BallArrangement::find_last_steps() {
    last_step_.assign(count_, -1);
    for (std::size_t k = 0; k < function_->steps.size(); ++k) last_step_[function_->steps[k].variable] = int(k);
}

/// Where p's circle is outside of plane q, for planes whose discs meet.
const BallArrangement::Arc& BallArrangement::arc(std::size_t p, std::size_t q) {
    Arc& arc = arcs_[q];
    if (arc.of_plane == p) return arc;
    const Chord& c = chord(p, q);
    const double phi = std::atan2(c.my, c.mx), beta = std::atan2(c.half, c.d);
    arc = {phi - beta, phi + beta, false, p};
    if (arc.from < -pi) {
        arc.from += 2 * pi;
        arc.wraps = true;
    }
    if (arc.to >= pi) {
        arc.to -= 2 * pi;
        arc.wraps = true;
    }
    return arc;
}

// Integrates around p's circle: returns Θₚ and adds p's terms to S.
double BallArrangement::add_arcs(const std::vector<BallPlane>& planes, std::size_t p, double& sphere) {
    const Circle& c = circles_[p];
    const auto psi = [&](double theta) {
        if (std::abs(theta) == pi) return theta;
        return 2 * std::atan2(c.near * std::sin(0.5 * theta), c.far * std::cos(0.5 * theta));
    };
    double of_theta = 0, of_psi = 0;
    pieces_.assign(1, {-pi, pi, function_->first, 1, -1, -1});
    while (!pieces_.empty()) {
        Piece piece = pieces_.back();
        pieces_.pop_back();
        while (piece.step >= 0 && (piece.of_p >= 0 || piece.step <= last_step_[p])) {
            const BooleanStep& step = function_->steps[piece.step];
            const std::size_t q = std::size_t(step.variable);
            if (q == p) {
                if (piece.of_p < 0) {
                    pieces_.push_back({piece.from, piece.to, step.if_false, -piece.sign, 0, -1});
                    piece.of_p = 1;
                }
                piece.step = piece.of_p ? step.if_true : step.if_false;
                continue;
            }
            const Chord& ch = chord(p, q);
            if (ch.half == 0) {
                piece.step = ch.d >= 0 ? step.if_true : step.if_false;
                continue;
            }
            // The function goes one way between `from` and `to`, and the other way before and after.
            const Arc& outside = arc(p, q);
            const double from = outside.wraps ? outside.to : outside.from,
                         to = outside.wraps ? outside.from : outside.to;
            const int within = outside.wraps ? step.if_true : step.if_false;
            const int beyond = outside.wraps ? step.if_false : step.if_true;
            if (to <= piece.from || from >= piece.to) {
                piece.step = beyond;
                continue;
            }
            const auto send = [&](double begin, double end, int next) {
                if (begin < end) pieces_.push_back({begin, end, next, piece.sign, piece.of_p, -1});
            };
            send(piece.from, from, beyond);
            send(to, piece.to, beyond);
            piece.from = std::max(piece.from, from);
            piece.to = std::min(piece.to, to);
            piece.step = within;
        }
        if (piece.step != ends_true || piece.of_p < 0) continue;
        of_theta += piece.sign * (piece.to - piece.from);
        of_psi += piece.sign * (psi(piece.to) - psi(piece.from));
    }
    sphere += planes[p].t * of_theta - c.side * of_psi;
    return of_theta;
}

// ∫ wₚq along the chord that q cuts in p's disc. Planes that cut the disc in the same line are crossed together with q;
// on_line_ holds those of them that the function asks for.
double BallArrangement::chord_length(std::size_t p, std::size_t q) {
    const Chord& ch = chord(p, q);
    double length = 0;
    on_line_.clear();
    pieces_.assign(1, {-ch.half, ch.half, function_->first, 1, -1, -1});
    while (!pieces_.empty()) {
        Piece piece = pieces_.back();
        pieces_.pop_back();
        while (piece.step >= 0 && (piece.of_p >= 0 || piece.step <= last_step_[p])) {
            const BooleanStep& step = function_->steps[piece.step];
            const std::size_t r = std::size_t(step.variable);
            if (r == p) {
                if (piece.of_p < 0) {
                    pieces_.push_back({piece.from, piece.to, step.if_false, -piece.sign, 0, piece.of_q});
                    piece.of_p = 1;
                }
                piece.step = piece.of_p ? step.if_true : step.if_false;
                continue;
            }
            const Chord& other = chord(p, r);
            if (other.half == 0) {
                piece.step = other.d >= 0 ? step.if_true : step.if_false;
                continue;
            }
            const double along = other.my * ch.mx - other.mx * ch.my;  // component along the chord of r's m
            const double across = other.mx * ch.mx + other.my * ch.my;
            const double room = other.d - ch.d * across;
            if (r == q || (!other.counted && std::abs(along) <= one_plane && std::abs(room) <= one_plane)) {
                if (r != q) on_line_.push_back(r);
                const bool same = across > 0;
                if (piece.of_q < 0) {
                    pieces_.push_back(
                        {piece.from, piece.to, same ? step.if_false : step.if_true, -piece.sign, piece.of_p, 0});
                    piece.of_q = 1;
                }
                piece.step = (piece.of_q == 1) == same ? step.if_true : step.if_false;
                continue;
            }
            // Inside r where along · y ≤ room, for y along the chord.
            if (std::abs(room) >= std::abs(along) * ch.half) {
                piece.step = room >= 0 ? step.if_true : step.if_false;
                continue;
            }
            const double cut = room / along;
            const int before = along > 0 ? step.if_true : step.if_false;
            const int after = along > 0 ? step.if_false : step.if_true;
            if (cut >= piece.to) {
                piece.step = before;
            } else if (cut <= piece.from) {
                piece.step = after;
            } else {
                pieces_.push_back({cut, piece.to, after, piece.sign, piece.of_p, piece.of_q});
                piece.to = cut;
                piece.step = before;
            }
        }
        if (piece.step == ends_true && piece.of_p >= 0 && piece.of_q >= 0)
            length += piece.sign * (piece.to - piece.from);
    }
    return length;
}

// Adds ½ Σ d · ∫ wₚq over the chords in p's disc to p's area, and the same term to the other plane's area if the chord
// is on no third plane.
void BallArrangement::add_chords(std::size_t p, std::vector<double>& areas) {
    for (std::size_t q = 0; q < count_; ++q) {
        Chord &of_p = chord(p, q), &of_q = chord(q, p);
        if (q == p || of_p.counted || of_p.half == 0) continue;
        const double length = chord_length(p, q);
        areas[p] += 0.5 * of_p.d * length;
        of_p.counted = true;
        for (const std::size_t r : on_line_) chord(p, r).counted = true;
        if (!on_line_.empty() || of_q.counted) continue;
        areas[q] += 0.5 * of_q.d * length;
        of_q.counted = true;
    }
}

double BallArrangement::measure(const std::vector<BallPlane>& planes, const BooleanSteps& function,
                                std::vector<double>& areas) {
    function_ = &function;
    count_ = planes.size();
    choose_pole(planes);
    find_chords(planes);
    find_last_steps();
    arcs_.assign(count_, {0, 0, false, count_});
    areas.assign(count_, 0);
    double sphere = function.value([&](int p) { return circles_[p].side > 0; }) ? 4 * pi : 0;
    for (std::size_t p = 0; p < count_; ++p) {
        const double radius = circles_[p].radius;
        areas[p] += 0.5 * radius * radius * add_arcs(planes, p, sphere);
        add_chords(p, areas);
    }
    double sum = 0;
    for (std::size_t p = 0; p < count_; ++p) sum += planes[p].t * areas[p];
    return std::clamp((sum + sphere) / (4 * pi), 0.0, 1.0);
}

}  // namespace deburr
