#include "raytracer/render/lights.hpp"

#include <algorithm>

#include "raytracer/render/daylight.hpp"

namespace deburr {

LightSource::LightSource(const Light& light)
    : kind_(light.kind),
      position_(light.position),
      direction_(0.0),
      u_(light.u),
      v_(light.v),
      emitted_(light.color * light.power) {
    switch (kind_) {
        case Light::Kind::point: emitted_ /= 4 * pi; break;
        case Light::Kind::directional: {
            const double length = glm::length(light.direction);
            if (length > 0) direction_ = light.direction / length;
            break;
        }
        case Light::Kind::area: {
            const Vec3 normal = glm::cross(u_, v_);
            area_ = glm::length(normal);
            samples_ = std::max(1, light.samples);
            if (area_ > 0) {
                direction_ = normal / area_;
                emitted_ /= pi * area_;
            }
            visible_ = light.visible && area_ > 0;
            break;
        }
        case Light::Kind::sphere: {
            samples_ = std::max(1, light.samples);
            radius_ = light.radius;
            area_ = 4 * pi * radius_ * radius_;
            if (area_ > 0) emitted_ /= pi * area_;
            visible_ = light.visible && area_ > 0;
            break;
        }
    }
}

Incident LightSource::at(Vec3 point, Vec2 u) const {
    Incident light;
    if (kind_ == Light::Kind::directional) {
        light.direction = -direction_;
        light.irradiance = emitted_;
        return light;
    }
    if (kind_ == Light::Kind::sphere) return at_sphere(point, u);
    Vec3 light_point = position_;
    if (kind_ == Light::Kind::area) light_point += (u.x - 0.5) * u_ + (u.y - 0.5) * v_;
    const Vec3 to_light = light_point - point;
    const double square = glm::dot(to_light, to_light);
    if (!(square > 0)) return light;
    light.distance = std::sqrt(square);
    const double inverse = 1 / light.distance;
    light.direction = to_light * inverse;
    if (kind_ == Light::Kind::point) {
        light.irradiance = emitted_ * (inverse * inverse);
        return light;
    }
    const double cosine = -glm::dot(direction_, light.direction);
    if (!(cosine > 0) || !(area_ > 0)) return light;
    light.density = square / (cosine * area_);
    light.irradiance = emitted_ / light.density;
    return light;
}

LightSource::Emission LightSource::seen(const Ray& ray, double t_max) const {
    if (kind_ == Light::Kind::sphere) return sphere_seen(ray, t_max);
    if (kind_ != Light::Kind::area || !(area_ > 0)) return {};
    const double cosine = -glm::dot(direction_, ray.direction);
    if (cosine == 0) return {};
    const double t = -glm::dot(position_ - ray.origin, direction_) / cosine;
    if (!(t > 0 && t < t_max)) return {};
    const Vec3 offset = ray.origin + t * ray.direction - position_;
    // Coordinates in the oblique frame (u, v), by Cramer's rule.
    const double a = glm::dot(glm::cross(offset, v_), direction_) / area_;
    const double b = glm::dot(glm::cross(u_, offset), direction_) / area_;
    if (std::abs(a) > 0.5 || std::abs(b) > 0.5) return {};
    if (cosine < 0) return {Vec3(0.0), 0.0, t};
    return {emitted_, t * t / (cosine * area_), t};
}

LightBounds LightSource::bounds() const {
    const double emitted = (emitted_.x + emitted_.y + emitted_.z) / 3;
    if (kind_ == Light::Kind::area) {
        const Vec3 half = 0.5 * (glm::abs(u_) + glm::abs(v_));
        return {{position_ - half, position_ + half}, emitted * area_, direction_, 0};
    }
    const double shine = kind_ == Light::Kind::sphere ? pi * radius_ * radius_ : 1.0;
    return {{position_ - Vec3(radius_), position_ + Vec3(radius_)}, emitted * shine};
}

// 1 − cosine of the half angle of the cone around a sphere of radius `r` at distance `d` > r, without cancellation for
// a distant one.
double cone_depth(double r, double d) {
    const double s2 = r * r / (d * d);
    return s2 / (1 + std::sqrt(std::max(0.0, 1 - s2)));
}

double cone_density(double r, double d) { return 1 / (2 * pi * cone_depth(r, d)); }

Vec3 cone_direction(Vec3 to_center, double r, double d, Vec2 u) {
    const double depth = u.x * cone_depth(r, d), cosine = 1 - depth;
    const double sine = std::sqrt(std::max(0.0, depth * (1 + cosine))), phi = 2 * pi * u.y;
    const Vec3 z = to_center / d;
    const Vec3 other = std::abs(z.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(z, other)), y = glm::cross(z, x);
    return sine * std::cos(phi) * x + sine * std::sin(phi) * y + cosine * z;
}

Incident LightSource::at_sphere(Vec3 point, Vec2 u) const {
    Incident light;
    const Vec3 to_center = position_ - point;
    const double d = glm::length(to_center);
    if (!(d > radius_) || !(area_ > 0) || !std::isfinite(d)) return light;
    light.direction = cone_direction(to_center, radius_, d, u);
    // The nearer intersection; at the cone's rim rounding may make its radicand negative.
    const double b = glm::dot(to_center, light.direction);
    const double root2 = b * b - (d - radius_) * (d + radius_);
    light.distance = b - std::sqrt(std::max(0.0, root2));
    light.density = cone_density(radius_, d);
    light.irradiance = emitted_ / light.density;
    return light;
}

LightSource::Emission LightSource::sphere_seen(const Ray& ray, double t_max) const {
    const Vec3 to_center = position_ - ray.origin;
    const double b = glm::dot(to_center, ray.direction), d = glm::length(to_center);
    const double c = (d - radius_) * (d + radius_), root2 = b * b - c;
    if (!(root2 >= 0) || !(area_ > 0)) return {};
    const double root = std::sqrt(root2);
    if (d <= radius_) return b + root < t_max ? Emission{Vec3(0.0), 0.0, b + root} : Emission{};
    const double t = c / (b + root);  // b − root, without cancellation for a distant sphere
    if (!(b > 0 && t > 0 && t < t_max)) return {};
    return {emitted_, cone_density(radius_, d), t};
}

double LightSource::importance(Vec3 point) const {
    const double emitted = (emitted_.x + emitted_.y + emitted_.z) / 3;
    if (kind_ == Light::Kind::directional) return emitted;
    const Vec3 to_light = position_ - point;
    const double square = glm::dot(to_light, to_light);
    switch (kind_) {
        case Light::Kind::point: return square > 0 ? emitted / square : 0.0;
        case Light::Kind::sphere: return square > radius_ * radius_ ? emitted * pi * radius_ * radius_ / square : 0.0;
        default: break;
    }
    if (!(glm::dot(direction_, to_light) < 0)) return 0.0;  // the light is planar, so all of it faces away
    return emitted * area_ / std::max(square, area_ / pi);
}

namespace {

// The sky's gradient is mix(horizon, zenith, √y). This is the cosine-weighted mean of √max(0, y) around a normal at
// height c, by a product rule in polar coordinates around the normal with equal areas of the projected disc: sin²θ and
// φ uniform.
double mean_zenith_share(double c) {
    constexpr int rings = 48, sectors = 48;
    static const auto cosines = [] {
        std::array<double, sectors> all;
        for (int j = 0; j < sectors; ++j) all[j] = std::cos(pi * (j + 0.5) / sectors);
        return all;
    }();
    const double s = std::sqrt(std::max(0.0, 1 - c * c));
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double sine2 = (i + 0.5) / rings;
        const double a = c * std::sqrt(1 - sine2), b = s * std::sqrt(sine2);
        for (const double cosine : cosines) sum += std::sqrt(std::max(0.0, a + b * cosine));
    }
    return sum / (rings * sectors);
}

}  // namespace

SkyLight::SkyLight(const Background& background) : background_(background) {
    if (!background.file.empty() || background.by_day()) {
        Background y_up = background;  // the orientation of pictures and of the day model
        if (background.z_up) y_up.sun = {background.sun.x, background.sun.z, -background.sun.y};
        picture_ = background.by_day() ? daylight(y_up) : background.picture;
        if (background.by_day()) {
            sun_.direction = glm::normalize(background.sun);
            const double half = 0.5 * background.sun_size * pi / 180;
            sun_.depth = 2 * std::pow(std::sin(0.5 * half), 2);
            sun_.radiance = sun_irradiance(y_up) * sun_.density();
            if (!(sun_.radiance.x + sun_.radiance.y + sun_.radiance.z > 0)) sun_.depth = 0;
        } else {
            cos_rotate_ = std::cos(background.rotate * pi / 180);
            sin_rotate_ = std::sin(background.rotate * pi / 180);
        }
        if (picture_) prepare_picture();
        return;
    }
    if (!background.sky) return;
    for (int i = 0; i <= steps; ++i) zenith_share_[i] = mean_zenith_share(2.0 * i / steps - 1);
}

Vec3 SkyLight::mean(Vec3 normal) const {
    if (picture_) {
        // The bands are attenuated by 1, 2/3 and 1/4 [Ramamoorthi & Hanrahan 2001, eq. 8, over π].
        const auto& [one, x, y, z, xy, yz, zx, xx_yy, zz] = harmonics_;
        const Vec3 n = normal;
        const Vec3 sum = one + 2.0 * (x * n.x + y * n.y + z * n.z) +
                         0.25 * (15.0 * (xy * n.x * n.y + yz * n.y * n.z + zx * n.z * n.x) +
                                 3.75 * xx_yy * (n.x * n.x - n.y * n.y) + 1.25 * zz * (3 * n.z * n.z - 1));
        return background_.scale * glm::max(sum, Vec3(0.0));
    }
    if (!background_.sky) return background_.color;
    const double at = glm::clamp(0.5 * (background_.height(normal) + 1), 0.0, 1.0) * steps;
    const auto i = at < steps ? std::size_t(at) : std::size_t(steps - 1);  // the last one for NaN, too
    const double share = glm::mix(zenith_share_[i], zenith_share_[i + 1], at - double(i));
    return glm::mix(background_.horizon, background_.zenith, share);
}

Vec3 SkyLight::Sun::at(Vec2 u) const {
    const double down = u.x * depth, cosine = 1 - down;
    const double sine = std::sqrt(std::max(0.0, down * (1 + cosine)));
    const Vec3 other = std::abs(direction.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(direction, other)), y = glm::cross(direction, x);
    return glm::normalize(sine * std::cos(2 * pi * u.y) * x + sine * std::sin(2 * pi * u.y) * y + cosine * direction);
}

Vec2 SkyLight::place_of(Vec3 d) const {
    if (background_.z_up) d = {d.x, d.z, -d.y};
    const double x = cos_rotate_ * d.x - sin_rotate_ * d.z, z = sin_rotate_ * d.x + cos_rotate_ * d.z;
    const double u = 0.5 + std::atan2(x, -z) / (2 * pi);
    return {u - std::floor(u), std::acos(glm::clamp(d.y, -1.0, 1.0)) / pi};
}

Vec3 SkyLight::direction_of(Vec2 place) const {
    const double phi = 2 * pi * (place.x - 0.5), theta = pi * place.y;
    const double x = std::sin(theta) * std::sin(phi), z = -std::sin(theta) * std::cos(phi);
    const Vec3 d(cos_rotate_ * x + sin_rotate_ * z, std::cos(theta), -sin_rotate_ * x + cos_rotate_ * z);
    return background_.z_up ? Vec3(d.x, -d.z, d.y) : d;
}

// Interpolates between the centers of four pixels.
Vec3 SkyLight::picture_towards(Vec3 direction) const {
    const Vec2 place = place_of(direction);
    const int width = picture_->width, height = picture_->height;
    const double x = place.x * width - 0.5, y = place.y * height - 0.5;
    if (!std::isfinite(x + y)) return Vec3(0.0);
    const double left = std::floor(x), top = std::floor(y);
    const auto pixel = [&](double column, double row) {
        const int i = (int(column) + width) % width, j = std::clamp(int(row), 0, height - 1);
        const float* rgb = &picture_->rgb[3 * (std::size_t(j) * width + i)];
        return Vec3(rgb[0], rgb[1], rgb[2]);
    };
    const Vec3 upper = glm::mix(pixel(left, top), pixel(left + 1, top), x - left);
    const Vec3 lower = glm::mix(pixel(left, top + 1), pixel(left + 1, top + 1), x - left);
    return background_.scale * glm::mix(upper, lower, y - top);
}

void SkyLight::prepare_picture() {
    const int width = picture_->width, height = picture_->height;
    rows_.assign(std::size_t(height) + 1, 0.0);
    columns_.assign(std::size_t(height) * (width + 1), 0.0);
    double area = 0;
    for (int j = 0; j < height; ++j) {
        const double weight = std::cos(pi * j / height) - std::cos(pi * (j + 1) / height);  // the row's solid angle
        double* column = &columns_[std::size_t(j) * (width + 1)];
        for (int i = 0; i < width; ++i) {
            const float* rgb = &picture_->rgb[3 * (std::size_t(j) * width + i)];
            const Vec3 color(rgb[0], rgb[1], rgb[2]);
            column[i + 1] = column[i] + (color.x + color.y + color.z) / 3;
            const Vec3 d = direction_of({(i + 0.5) / width, (j + 0.5) / height});
            const double polynomials[9] = {
                1, d.x, d.y, d.z, d.x * d.y, d.y * d.z, d.z * d.x, d.x * d.x - d.y * d.y, 3 * d.z * d.z - 1};
            for (int k = 0; k < 9; ++k) harmonics_[k] += weight * polynomials[k] * color;
        }
        area += weight * width;
        rows_[j + 1] = rows_[j] + weight * column[width];
    }
    for (Vec3& h : harmonics_) h /= area;
    total_ = rows_[height] / area;
}

namespace {

// The interval of a cumulative sum that contains `at`, and the position in it from 0 to 1.
std::pair<int, double> interval(const double* sums, int count, double at) {
    const int i = std::clamp(int(std::upper_bound(sums, sums + count + 1, at) - sums) - 1, 0, count - 1);
    const double width = sums[i + 1] - sums[i];
    return {i, width > 0 ? glm::clamp((at - sums[i]) / width, 0.0, 1.0) : 0.5};
}

}  // namespace

Vec3 SkyLight::sample(Vec2 u) const {
    const int width = picture_->width, height = picture_->height;
    const auto [row, down] = interval(rows_.data(), height, u.y * rows_[height]);
    const double* columns = &columns_[std::size_t(row) * (width + 1)];
    const auto [column, right] = interval(columns, width, u.x * columns[width]);
    // Uniform in solid angle within the row.
    const double cosine = glm::mix(std::cos(pi * row / height), std::cos(pi * (row + 1) / height), down);
    return direction_of({(column + right) / width, std::acos(glm::clamp(cosine, -1.0, 1.0)) / pi});
}

double SkyLight::density(Vec3 direction) const {
    if (!picture_ || !(total_ > 0)) return 0.0;
    const Vec2 place = place_of(direction);
    const int width = picture_->width, height = picture_->height;
    const int i = std::clamp(int(place.x * width), 0, width - 1), j = std::clamp(int(place.y * height), 0, height - 1);
    const double* columns = &columns_[std::size_t(j) * (width + 1)];
    return (columns[i + 1] - columns[i]) / (total_ * 4 * pi);
}

}  // namespace deburr
