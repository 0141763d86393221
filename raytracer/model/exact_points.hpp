// Points with rational coordinates, by number: equal ones have one. They begin as the vertices of a surface.
#pragma once
#include <map>
#include <set>
#include <vector>

#include "raytracer/model/exact_plane.hpp"

namespace deburr {

class ExactPoints {
public:
    /// Keeps a reference to the vertices, no two of which are equal.
    explicit ExactPoints(const std::vector<Vec3>& vertices) : vertices_(vertices) {}
    ExactPoints(const ExactPoints&) = delete;
    ExactPoints& operator=(const ExactPoints&) = delete;

    /// The number of this vertex.
    int of_vertex(int vertex);
    /// Whether the vertex has this number.
    bool is_vertex(int vertex, int number) const;
    /// The number of the point, which is added if there is none that is equal.
    int number_of(const ExactPoint& point);
    /// Adds a point that no other is asked to be equal to.
    int add(Vec3 x);

    const ExactPoint& operator[](int number) const { return points_[number]; }
    const std::vector<ExactPoint>& all() const { return points_; }
    /// The order by coordinates; along a line that is one of its directions.
    bool before(int a, int b) const { return comes_before(points_[a], points_[b]); }

private:
    struct Before {
        const std::vector<ExactPoint>* points;
        bool operator()(int a, int b) const { return comes_before((*points)[a], (*points)[b]); }
    };

    const std::vector<Vec3>& vertices_;
    std::vector<ExactPoint> points_;
    std::set<int, Before> known_{Before{&points_}};
    std::map<int, int> of_vertex_;  // of those that were asked for
};

}  // namespace deburr
