// A scene: solids, materials, lights, a camera and a picture's size, as plain data.
//
// Units: lengths are the scene's own; colours are linear Rec. 709; power is in watts, so a point
// light's radiant intensity is power·color/4π, an area or sphere light's radiance power·color/(π·area), and
// a directional light's `power` is the irradiance on a surface that faces it.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bounds/solid.hpp"
#include "bounds/vec.hpp"
#include "raytracer/util/source_map.hpp"

namespace deburr {

/// Samples per pixel, of a scene and of the command line.
constexpr int max_samples = 1 << 20;

/// Stops of exposure, either way.
constexpr double max_exposure = 30;

/// A picture in memory.
struct PictureData {
    int width = 0, height = 0;
    std::vector<float> rgb;  // row by row from the top
};

/// A colour that may vary through space.
struct Texture {
    enum class Kind { constant, checker, wood, marble, noise, brushed, image };
    Kind kind = Kind::constant;
    Vec3 a{0.8}, b{0.2};  // constant: a; wood: early wood and late wood; marble: ground and veins; image: its mean
    // checker: side of a cube; wood: width of a year's ring; marble: distance of veins; noise: of a light place from a
    // dark one; brushed: width of a streak; image: width of the picture
    double scale = 1.0;
    Vec3 axis{1, 0, 0};  // wood: direction of the trunk; marble: across the veins; brushed: along the streaks
    Vec3 origin{0, 0, 0};
    double turbulence = 1.0;                    // marble
    int octaves = 1;                            // noise: each of half the size and depth of the one before
    bool around = false;                        // brushed: around the axis, in place of along it
    double rotate = 0.0, blend = 0.25;          // image: degrees, counter-clockwise; width of the blends between sides
    bool z_up = false;                          // image: is up z, or y
    std::string file{};                         // image: the picture's
    std::shared_ptr<const PictureData> data{};  // image: what is in it, once it was read
};

struct Material {
    enum class Kind { matte, plastic, metal, mirror, glass, pbr };
    Kind kind = Kind::matte;
    Texture color;
    double roughness = 0.2;  // GGX: α = roughness², 0 smooth; not used by matte, mirror
    double ior = 1.5;        // plastic, glass, pbr
    Vec3 emission{0.0};      // radiance that the outside of the surface sends out
    // pbr: shares from 0 to 1, by glTF's names
    double metallic = 0.0, transmission = 0.0, clearcoat = 0.0, clearcoat_roughness = 0.0;
    // In place of the number, which is then the mean; null: none.
    std::shared_ptr<const Texture> roughness_texture{}, metallic_texture{};
    // Where it is 1, the surface seems to be higher by bump_height than where it is 0; null: it is as it is.
    std::shared_ptr<const Texture> bump{};
    double bump_height = 0.05;
};

struct Light {
    enum class Kind { point, directional, area, sphere };
    Kind kind = Kind::point;
    Vec3 position{0.0};           // point; area, sphere: its centre
    Vec3 direction{0, -1, 0};     // directional: the way the light travels, unit
    Vec3 u{1, 0, 0}, v{0, 0, 1};  // area: its two sides; it shines towards u × v
    Vec3 color{1.0};
    double power = 1.0;
    int samples = 1;      // area, sphere: shadow rays per shading point
    double radius = 1.0;  // sphere
    bool visible = true;  // area, sphere: the camera sees it, and it hides what is behind it
};

struct Camera {
    Vec3 eye{3, 2, 4}, target{0.0}, up{0, 1, 0};
    double fov = 40.0;          // vertical, degrees
    bool orthographic = false;  // rays are parallel; the picture is as high as fov sees it at the target
    double lens_radius = 0.0;   // 0: a pinhole, all is sharp
    double focus = 0.0;         // distance along the axis of what is sharp; 0: the target's
    Vec3 shift{0.0};            // of the picture in its plane, in widths and heights, to the right and up; z unused
};

/// How a camera looks at the solids that is placed by their bounds (frame_camera.hpp).
struct Framing {
    Vec3 from{3, 2, 4};  // the direction from the solids to the eye, of any length
    double fov = 30.0;   // vertical, degrees
};

/// Colour that rays see that hit nothing; also the ambient light.
struct Background {
    bool sky = false;  // a gradient from horizon to zenith, by height()
    Vec3 color{0.0};   // one colour where there is no sky
    Vec3 horizon{0.46, 0.5, 0.55}, zenith{0.2, 0.28, 0.4};
    bool z_up = false;  // is up z, or y
    // A clear sky by day, in place of the gradient, with a sun in this direction; {0, 0, 0}: none
    Vec3 sun{0.0};
    double turbidity = 3.0, sun_size = 0.533;  // haze; degrees across
    // Of a picture by longitude and latitude, in place of the others, whose middle lies towards -z and whose top at y;
    // "": none
    std::string file;
    std::shared_ptr<const PictureData> picture;  // what is in it, linear, once it was read
    double scale = 1.0, rotate = 0.0;            // of picture and day; degrees about y

    bool by_day() const { return sun != Vec3(0.0); }
    /// Height of a unit direction: 1 towards the zenith, 0 towards the horizon.
    double height(Vec3 direction) const { return z_up ? direction.z : direction.y; }
    /// Neither of a picture nor by day.
    Vec3 towards(Vec3 unit_direction) const {
        if (!sky) return color;
        return glm::mix(horizon, zenith, std::sqrt(glm::max(0.0, height(unit_direction))));
    }
};

struct Scene {
    std::string file;                               // as the user named it
    SourceMap sources;                              // where the solids' lines are
    std::map<std::string, std::string> parameters;  // every param() the scene read, with its value
    int width = 600, height = 380;
    std::optional<int> spp;  // samples per pixel; none: as many as it takes (sample_count.hpp)
    int bounces = 4;         // depth of mirror and glass paths in previews
    bool caustics = false;   // true: highlights and light through glass fall exactly where they do
    double exposure = 0;     // of pictures for the screen, in stops: light counts 2^exposure times
    bool z_up = false;       // is up z, or y
    Camera camera;
    std::optional<Framing> framing;  // where the camera is placed by the solids' bounds
    std::vector<Light> lights;
    bool default_light = false;  // lights holds one, which follows the camera
    Background background;
    std::optional<Background>
        environment;    // what gives light in place of the background, which then only the camera sees
    Vec3 ambient{0.0};  // constant radiance from all around, seen by diffuse surfaces only
    const Background& lighting() const { return environment ? *environment : background; }

    std::vector<Material> materials;       // never empty: index 0 is for solids that name none
    std::vector<Solid> solids;             // separate objects; ids are 1, 2, … in this order
    std::vector<std::string> names;        // of the solids, "" where they have none
    std::vector<std::string> model_files;  // paths that it was read from besides
    std::vector<std::string> notes;        // what was mended in these, a line each

    /// "lid.lua:7", of a solid's line; where that is 0, the file alone.
    std::string place(int line) const { return sources.empty() ? file : sources.place(line); }
};

}  // namespace deburr
