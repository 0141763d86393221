// The scene as plain data: solids, materials, lights, a camera and the picture's size.
//
// Units: lengths are the scene's own; colours are linear Rec. 709; power is in watts, so the radiant intensity of a
// point light is power·color/4π and the radiance of an area or sphere light power·color/(π·area); the `power` of a
// directional light is the irradiance on a surface that faces it.
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

/// Most samples per pixel that a scene or the command line may ask for.
constexpr int max_samples = 1 << 20;

/// Largest magnitude of the exposure, in stops.
constexpr double max_exposure = 30;

/// An image in memory.
struct PictureData {
    int width = 0, height = 0;
    std::vector<float> rgb;  // row by row from the top
};

/// A colour that may vary in space.
struct Texture {
    enum class Kind { constant, checker, wood, marble, noise, brushed, image };
    Kind kind = Kind::constant;
    Vec3 a{0.8}, b{0.2};  // constant: a; wood: early and late wood; marble: ground and veins; image: a is its mean
    // In scene units. checker: side of a cube; wood: width of a year's ring; marble: distance of veins; noise: distance
    // between light and dark places; brushed: width of a streak; image: width of the picture.
    double scale = 1.0;
    Vec3 axis{1, 0, 0};  // wood: the trunk's direction; marble: across the veins; brushed: along the streaks
    Vec3 origin{0, 0, 0};
    double turbulence = 1.0;                    // marble: strength
    int octaves = 1;                            // noise: layers, each of half the size and amplitude of the one before
    bool around = false;                        // brushed: whether streaks run around the axis instead of along it
    double rotate = 0.0, blend = 0.25;          // image: degrees, counter-clockwise; width of the blend between sides
    bool z_up = false;                          // image: whether z is up instead of y
    std::string file{};                         // image: path of the picture
    std::shared_ptr<const PictureData> data{};  // image: the picture, once it was read
};

/// A material: the parameters of a surface's scattering and emission.
struct Material {
    enum class Kind { matte, plastic, metal, mirror, glass, pbr };
    Kind kind = Kind::matte;
    Texture color;
    double roughness = 0.2;  // GGX α = roughness², 0: smooth; not for matte, mirror
    double ior = 1.5;        // plastic, glass, pbr
    Vec3 emission{0.0};      // radiance that the outer side of the surface emits
    // pbr: from 0 to 1, named as in glTF.
    double metallic = 0.0, transmission = 0.0, clearcoat = 0.0, clearcoat_roughness = 0.0;
    // Textures that replace the number, which is then their mean; null: none.
    std::shared_ptr<const Texture> roughness_texture{}, metallic_texture{};
    // Bump map: where it is 1 the surface appears higher by bump_height than where it is 0; null: none.
    std::shared_ptr<const Texture> bump{};
    double bump_height = 0.05;  // scene length
};

/// A light source; a comment that begins with kinds applies to these only.
struct Light {
    enum class Kind { point, directional, area, sphere };
    Kind kind = Kind::point;
    Vec3 position{0.0};           // point; area, sphere: its center
    Vec3 direction{0, -1, 0};     // directional: direction in which light travels, unit
    Vec3 u{1, 0, 0}, v{0, 0, 1};  // area: its two sides; it shines towards u × v
    Vec3 color{1.0};
    double power = 1.0;   // see the top of this file
    int samples = 1;      // area, sphere: shadow rays per shading point, in previews
    double radius = 1.0;  // sphere
    bool visible = true;  // area, sphere: whether the camera sees it and it hides what is behind it
};

/// A perspective or orthographic camera.
struct Camera {
    Vec3 eye{3, 2, 4}, target{0.0}, up{0, 1, 0};
    double fov = 40.0;          // vertical, degrees
    bool orthographic = false;  // parallel rays; the picture is as high as fov sees at the target
    double lens_radius = 0.0;   // scene length; 0: a pinhole
    double focus = 0.0;         // distance of the plane in focus along the axis; 0: the target's
    Vec3 shift{0.0};            // of the picture in its plane, in its width and height, to the right and up; z unused
};

/// The view of a camera that is placed by the solids' bounds (frame_camera.hpp).
struct Framing {
    Vec3 from{3, 2, 4};  // direction from the solids to the eye, of any length
    double fov = 30.0;   // vertical, degrees
};

/// The radiance that rays see that hit nothing; it also lights the scene.
struct Background {
    bool sky = false;  // a gradient from horizon to zenith, by height()
    Vec3 color{0.0};   // constant colour if not a sky
    Vec3 horizon{0.46, 0.5, 0.55}, zenith{0.2, 0.28, 0.4};
    bool z_up = false;  // whether z is up instead of y
    // A clear sky by day instead of the gradient, with the sun in this direction; {0, 0, 0}: none.
    Vec3 sun{0.0};
    double turbidity = 3.0, sun_size = 0.533;  // haziness; degrees across
    // An environment picture by longitude and latitude instead of all others; its middle is towards -z and its top at
    // y. "": none.
    std::string file;
    std::shared_ptr<const PictureData> picture;  // linear light, once it was read
    double scale = 1.0, rotate = 0.0;            // of the picture and the day sky: factor; degrees about y

    bool by_day() const { return sun != Vec3(0.0); }
    /// Sine of a unit direction's elevation: 1 at the zenith, 0 at the horizon.
    double height(Vec3 direction) const { return z_up ? direction.z : direction.y; }
    /// Colour in a direction, for a constant colour or gradient.
    Vec3 towards(Vec3 unit_direction) const {
        if (!sky) return color;
        return glm::mix(horizon, zenith, std::sqrt(glm::max(0.0, height(unit_direction))));
    }
};

/// Everything that a picture is made of.
struct Scene {
    std::string file;                               // path as the user gave it
    SourceMap sources;                              // files and lines of the solids
    std::map<std::string, std::string> parameters;  // every param() that the scene read, with its value
    int width = 600, height = 380;
    std::optional<int> spp;  // samples per pixel; none: chosen by noise (sample_count.hpp)
    int bounces = 4;         // depth of mirror and glass paths in previews
    bool caustics = false;   // true: light that polished surfaces and glass focus is not blurred
    double exposure = 0;     // of pictures for the screen, in stops
    bool z_up = false;       // whether z is up instead of y
    Camera camera;
    std::optional<Framing> framing;  // if the camera is placed by the solids' bounds
    std::vector<Light> lights;
    bool default_light = false;  // whether `lights` holds the default light, which follows the camera
    Background background;
    std::optional<Background>
        environment;    // lights the scene instead of the background, which then only the camera sees
    Vec3 ambient{0.0};  // constant radiance from all around, for diffuse surfaces
    const Background& lighting() const { return environment ? *environment : background; }

    std::vector<Material> materials;       // never empty: index 0 is for solids without one
    std::vector<Solid> solids;             // separate objects, with ids 1, 2, … in this order
    std::vector<std::string> names;        // of the solids; "": none
    std::vector<std::string> model_files;  // paths of models that it was read from
    std::vector<std::string> notes;        // repairs of these models, a line each

    /// The place of a solid's line, such as "lid.lua:7"; for line 0, the file only.
    std::string place(int line) const { return sources.empty() ? file : sources.place(line); }
};

}  // namespace deburr
