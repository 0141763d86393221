#include "bounds/field.hpp"

#include <algorithm>

#include "bounds/closed_mesh.hpp"

namespace deburr {
namespace {

// A field carried along by an affine map; it wraps fields that have no better way (Field::transformed_by).
class PlacedField final : public Field {
public:
    PlacedField(FieldPtr inner, const Affine& map, const Affine& inverse)
        : inner_(std::move(inner)), map_(map), inverse_(inverse) {}

    ValueGradient at(Vec3 x) const override {
        ValueGradient v = inner_->at(inverse_(x));
        v.gradient = glm::transpose(inverse_.linear) * v.gradient;
        return v;
    }
    Range range(const Box& box) const override { return inner_->range(image(inverse_, box)); }
    Box bounding_box() const override {
        const Box box = inner_->bounding_box();
        return box.empty() ? box : image(map_, box);
    }
    Box extent() const override {
        const Box box = inner_->extent();
        return box.empty() ? box : image(map_, box);
    }
    FieldPtr prune(const Box& box) const override {
        FieldPtr left = inner_->prune(image(inverse_, box));
        return left ? std::make_shared<PlacedField>(std::move(left), map_, inverse_) : nullptr;
    }
    std::optional<DensityTree> as_density(const Box& box) const override {
        std::optional<DensityTree> density = inner_->as_density(image(inverse_, box));
        if (!density) return density;
        for (HalfSpace& h : density->half_spaces) h = deburr::transformed(h, map_, true);
        density->ball = map_.linear * density->ball;
        return density;
    }
    bool is_density() const override { return inner_->is_density(); }
    std::shared_ptr<const ClosedMesh> sharp_mesh() const override {
        const auto mesh = inner_->sharp_mesh();
        return mesh ? deburr::transformed(*mesh, map_) : nullptr;
    }
    // The radius along the direction in which the map shrinks it most.
    double filter_radius() const override {
        const Mat3 square = glm::transpose(map_.linear) * map_.linear;
        const Vec3 v = eigensystem(square).values;
        return inner_->filter_radius() * std::sqrt(std::max(0.0, min_component(v)));
    }
    std::vector<HalfSpace> planes() const override {
        std::vector<HalfSpace> planes = inner_->planes();
        for (HalfSpace& h : planes) h = deburr::transformed(h, map_, true);
        return planes;
    }
    Range rate_range(const Box& box, Vec3 direction) const override {
        const Vec3 along = inverse_.linear * direction;
        const double speed = glm::length(along);
        const Range rate = inner_->rate_range(image(inverse_, box), along / speed);
        return {rate.lo * speed, rate.hi * speed};
    }
    int size() const override { return inner_->size(); }
    LocalSize local_size(const Box& box) const override { return inner_->local_size(image(inverse_, box)); }
    FieldPtr transformed_by(const Affine& map) const override { return transformed(inner_, compose(map, map_)); }

    double last_sign_change_bound(Vec3 origin, Vec3 direction) const override {
        return inner_->last_sign_change_bound(inverse_(origin), inverse_.linear * direction);
    }
    void begin_ray(FieldRay& ray) const override {  // from here on the ray is in the inner field's space
        ray.origin = inverse_(ray.origin);
        ray.direction = inverse_.linear * ray.direction;
        ray.field = inner_.get();
        inner_->begin_ray(ray);
    }
    double max_noise_scale(const Box& box) const override { return inner_->max_noise_scale(image(inverse_, box)); }
    ValueSlope at(const FieldRay& ray, double t) const override { return ray.field->at(ray, t); }
    RayBounds bounds(const FieldRay& ray, double t0, double t1) const override {
        return ray.field->bounds(ray, t0, t1);
    }

private:
    FieldPtr inner_;
    Affine map_, inverse_;
};

bool finite(const Affine& map) {
    for (int k = 0; k < 3; ++k)
        for (int row = 0; row < 3; ++row)
            if (!std::isfinite(map.linear[k][row]) || !std::isfinite(map.shift[row])) return false;
    return true;
}

}  // namespace

FieldPtr transformed(const FieldPtr& field, const Affine& map) {
    const Affine back = inverse(map);
    if (!finite(map) || !finite(back)) return nullptr;
    if (map.linear == Mat3(1.0) && map.shift == Vec3(0.0)) return field;
    if (FieldPtr own = field->transformed_by(map)) return own;
    return std::make_shared<PlacedField>(field, map, back);
}

double leaves_box(const Box& box, Vec3 origin, Vec3 direction) {
    double t = infinity;
    for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0) continue;
        const double side = direction[k] > 0 ? box.hi[k] : box.lo[k];
        if (std::isfinite(side)) t = std::min(t, (side - origin[k]) / direction[k]);
    }
    return std::max(0.0, t);
}

}  // namespace deburr
