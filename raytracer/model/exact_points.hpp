// A list of points with rational coordinates in which equal points have one index, starting from the vertices of a
// surface.
#pragma once
#include <map>
#include <set>
#include <vector>

#include "raytracer/model/exact_plane.hpp"

namespace deburr {

/// The points; they are added as they are needed.
class ExactPoints {
public:
    /// Keeps a reference to the vertices, which must all be different.
    explicit ExactPoints(const std::vector<Vec3>& vertices) : vertices_(vertices) {}
    ExactPoints(const ExactPoints&) = delete;
    ExactPoints& operator=(const ExactPoints&) = delete;

    /// The index of this vertex.
    int of_vertex(int vertex);
    /// Whether the vertex has been asked for and has this index.
    bool is_vertex(int vertex, int number) const;
    /// The index of the point, which is added unless an equal one exists.
    int number_of(const ExactPoint& point);
    /// Adds a point without looking for an equal one; returns its index.
    int add(Vec3 x);

    const ExactPoint& operator[](int number) const { return points_[number]; }
    const std::vector<ExactPoint>& all() const { return points_; }
    /// Lexicographic order of the coordinates; points on one line are in order along it.
    bool before(int a, int b) const { return comes_before(points_[a], points_[b]); }

private:
    // The lexicographic order of points, by index.
    struct Before {
        const std::vector<ExactPoint>* points;
        bool operator()(int a, int b) const { return comes_before((*points)[a], (*points)[b]); }
    };

    const std::vector<Vec3>& vertices_;
    std::vector<ExactPoint> points_;
    std::set<int, Before> known_{Before{&points_}};
    std::map<int, int> of_vertex_;  // of the vertices that were asked for
};

}  // namespace deburr
