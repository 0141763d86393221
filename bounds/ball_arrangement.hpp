// How planes cut the unit ball, and the volume and areas of what they cut out.
#pragma once
#include <vector>

#include "bounds/truth_table.hpp"

namespace deburr {

/// n·y = t; the side n·y ≤ t is where its variable is true.
struct BallPlane {
    Vec3 normal;
    double t;
};

/// Memory that is used again and again.
class BallArrangement {
public:
    /// Planes that are distinct and meet the ball, variable by variable of `table`.
    /// Returns the volume's share, and for each plane the area of its part of the surface: positive
    /// where what is cut out lies on its inner side.
    double measure(const std::vector<BallPlane>& planes, TruthTable& table, std::vector<double>& areas);

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
    };
    struct Event {
        double at;
        int variable;
        bool operator<(const Event& o) const { return at < o.at; }
    };

    void arrange(const std::vector<BallPlane>& planes, TruthTable& table);
    void join(const std::vector<BallPlane>& planes);
    double arcs(const std::vector<BallPlane>& planes, std::size_t p, TruthTable& table, double& sphere);
    double chords(std::size_t p, TruthTable& table);
    int weight(std::size_t p, TruthTable& table) const;
    Chord& chord(std::size_t p, std::size_t q) { return chords_[p * count_ + q]; }

    std::size_t count_ = 0;
    std::vector<Circle> circles_;
    std::vector<Chord> chords_;
    std::vector<Event> events_;
    std::vector<char> done_;
    std::vector<std::size_t> line_;
};

/// Planes this near to one another, in direction and in distance, count as one.
constexpr double one_plane = 1e-8;

}  // namespace deburr
