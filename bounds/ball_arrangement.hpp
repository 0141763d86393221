// How planes cut the unit ball, and the volume and areas of what they cut out.
#pragma once
#include <vector>

#include "bounds/short_circuit.hpp"

namespace deburr {

/// n·y = t; the side n·y ≤ t is where its variable is true.
struct BallPlane {
    Vec3 normal;
    double t;
};

/// Memory that is used again and again.
class BallArrangement {
public:
    /// Planes that are distinct and meet the ball, variable by variable of `function`.
    /// Returns the volume's share, and for each plane the area of its part of the surface: positive
    /// where what is cut out lies on its inner side.
    double measure(const std::vector<BallPlane>& planes, const BooleanSteps& function, std::vector<double>& areas);

private:
    struct Circle {
        Vec3 u, v;         // the plane's axes; u leans to the pole
        double radius;     // of the disc
        double near, far;  // |distance of the antipole from the plane|; 1 + the height at u
        int side;          // of the antipole: 1 within
    };
    // What plane p's disc has of plane q: inside where m·y ≤ d.
    struct Chord {
        double mx = 1, my = 0;  // m in p's axes
        double d = 0;           // if they do not meet: > 0 inside, else outside
        double half = 0;        // half its length; 0: they do not meet in the ball
        bool counted = false;   // its part of p's area is added
    };
    // Where p's circle is outside of another plane: from `from` to `to`, past ±π if `wraps`.
    struct Arc {
        double from, to;
        bool wraps;
        std::size_t of_plane;  // the p for which it was found
    };
    // A part of a chord or of a circle on its way through the function's steps.
    struct Piece {
        double from, to;
        int step;
        int sign;                // of what it adds
        signed char of_p, of_q;  // what the planes in question were taken to be: 1 true, 0 false, −1 neither yet
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
    std::vector<Arc> arcs_;       // of one circle
    std::vector<int> last_step_;  // that looks at each plane
    std::vector<Piece> pieces_;
    std::vector<std::size_t> on_line_;  // planes that meet p in the chord in question
};

/// Planes this near to one another, in direction and in distance, count as one.
constexpr double one_plane = 1e-8;

}  // namespace deburr
