// The arrangement of planes in the unit ball: volume and areas of the part of the ball where a Boolean function of the
// planes is true.
#pragma once
#include <vector>

#include "bounds/short_circuit.hpp"

namespace deburr {

/// The plane n·y = t; its variable is true on the side n·y ≤ t.
struct BallPlane {
    Vec3 normal;
    double t;
};

/// Measures arrangements. The object keeps its memory, so it is cheap to use again and again; several threads must not
/// use it at once.
class BallArrangement {
public:
    /// The fraction of the ball's volume in which `function` is true, in [0, 1]. planes[v] is variable v of the
    /// function; planes must be distinct and meet the ball. areas[v] becomes the signed area of plane v's part of the
    /// true region's surface: positive where the region lies on the plane's inner side.
    double measure(const std::vector<BallPlane>& planes, const BooleanSteps& function, std::vector<double>& areas);

private:
    /// The circle in which a plane cuts the sphere.
    struct Circle {
        Vec3 u, v;         // orthonormal axes in the plane; u leans towards the pole
        double radius;     // of the disc
        double near, far;  // |distance of the antipole from the plane|; 1 + the height of the circle's point at u
        int side;          // of the plane on which the antipole is: 1 inside, −1 outside
    };
    // How plane q cuts plane p's disc: q's inside is m·y ≤ d.
    struct Chord {
        double mx = 1, my = 0;  // m, a unit vector in p's axes
        double d = 0;           // if the planes do not meet in the ball: ≥ 0 if the disc is inside q, else negative
        double half = 0;        // half the chord's length; 0 if the planes do not meet in the ball
        bool counted = false;   // whether its term is in p's area already
    };
    // The arc of p's circle that is outside of another plane: from `from` to `to`, across ±π if `wraps`.
    struct Arc {
        double from, to;
        bool wraps;
        std::size_t of_plane;  // the plane p for which it was found
    };
    // A part of a chord or circle that is being sent through the function's steps.
    struct Piece {
        double from, to;
        /// Index of the next step, or how the evaluation ended.
        int step;
        int sign;                // of its contribution
        signed char of_p, of_q;  // value that p and q were taken to have: 1 true, 0 false, −1 not asked for yet
    };

    void choose_pole(const std::vector<BallPlane>& planes);
    void find_chords(const std::vector<BallPlane>& planes);
    void find_last_steps();
    const Arc& arc(std::size_t p, std::size_t q);
    double add_arcs(const std::vector<BallPlane>& planes, std::size_t p, double& sphere);
    void add_chords(std::size_t p, std::vector<double>& areas);
    double chord_length(std::size_t p, std::size_t q);
    Chord& chord(std::size_t p, std::size_t q) { return chords_[p * count_ + q]; }

    const BooleanSteps* function_ = nullptr;
    std::size_t count_ = 0;
    std::vector<Circle> circles_;
    std::vector<Chord> chords_;
    std::vector<Arc> arcs_;       // outside of each plane, of one circle
    std::vector<int> last_step_;  // for each plane, the last step that asks for it
    std::vector<Piece> pieces_;
    std::vector<std::size_t> on_line_;  // planes through the chord that was measured last
};

/// Planes that differ by less than this, in normal and in distance, count as one plane.
constexpr double one_plane = 1e-8;

}  // namespace deburr
