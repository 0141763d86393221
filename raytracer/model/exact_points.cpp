#include "raytracer/model/exact_points.hpp"

namespace deburr {

int ExactPoints::of_vertex(int vertex) {
    const auto [at, is_new] = of_vertex_.try_emplace(vertex, -1);
    if (is_new) at->second = number_of(ExactPoint(vertices_[vertex]));
    return at->second;
}

bool ExactPoints::is_vertex(int vertex, int number) const {
    const auto at = of_vertex_.find(vertex);
    return at != of_vertex_.end() && at->second == number;
}

int ExactPoints::number_of(const ExactPoint& point) {
    points_.push_back(point);
    const auto [at, is_new] = known_.insert(int(points_.size()) - 1);
    if (!is_new) points_.pop_back();
    return *at;
}

int ExactPoints::add(Vec3 x) {
    points_.emplace_back(x);
    return int(points_.size()) - 1;
}

}  // namespace deburr
