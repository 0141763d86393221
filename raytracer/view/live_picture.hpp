// The picture of a scene while it is being viewed: first coarse, then sharp, then refined in passes.
//
// A thread of its own does the work. Any change of the scene's file, a parameter or the camera cancels the passes under
// way, and the next frame shows the latest request. The final picture equals that of `deburr render`. Frames hold
// display values (sRGB).
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "raytracer/image/film.hpp"
#include "raytracer/image/view_transform.hpp"
#include "raytracer/mesh/wire_frame.hpp"
#include "raytracer/scene/scene.hpp"
#include "raytracer/trace/bsp_store.hpp"
#include "raytracer/trace/ray_tracer.hpp"

namespace deburr {

/// A frame: the picture as it was shown at one time.
struct LiveFrame {
    int number = 0;                    // counts from 1
    int width = 0, height = 0;         // of `rgba`, which may be coarser than the picture
    std::string rgba;                  // 8 bits each, row by row, as the browser's canvas takes it
    int samples = 0, all_samples = 0;  // done and wanted; 0: a preview
    bool is_finished = false;
    std::string error;  // why the scene could not be read; the picture is then an earlier one
    int scene = 0;      // number of scenes read so far
};

/// The surface that is visible at a point of the picture.
struct PickedSurface {
    int solid = 0, material = 0;  // indices in Scene::solids and Scene::materials
    Vec3 position, normal;
};

/// Renders a scene continuously. All functions may be called from any thread.
class LivePicture {
public:
    /// Reads the scene with these parameters; throws if that fails.
    using Load = std::function<Scene(const std::map<std::string, std::string>& parameters)>;

    /// Settings that stay the same.
    struct Settings {
        std::optional<int> spp;  // samples per pixel; none: the scene's, or chosen by its noise
        ViewTransform view = ViewTransform::standard;
    };

    /// Starts the thread, which reads the scene and renders it.
    LivePicture(Load load, const Settings& settings);
    ~LivePicture();
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    /// Waits for the first frame with a number above `after`; null if none comes in time.
    std::shared_ptr<const LiveFrame> wait_for_frame(int after, std::chrono::milliseconds time) const;

    /// The functions reload() to show_wires() request a new picture: of the scene read again, with these parameters,
    /// from this camera (none: the scene's own), and with or without the mesh's wire frame over it.
    void reload();
    void set_parameters(const std::map<std::string, std::string>& parameters);
    void set_camera(const std::optional<Camera>& camera);
    void show_wires(bool shown);

    /// The current scene with the camera that it is seen by; null before the first was read.
    std::shared_ptr<const Scene> scene() const;
    /// The surface at a point of the whole picture, in pixels from its upper left corner; none if nothing is hit.
    std::optional<PickedSurface> pick(double x, double y) const;
    /// The picture rendered so far, and the number of samples that its pixels have; null before the first.
    std::shared_ptr<const Film> film(int& samples) const;

private:
    struct World;
    void run();
    bool read_scene();
    void show_preview(const std::shared_ptr<const World>& world, int coarseness, bool may_be_cut);
    void refine(const std::shared_ptr<const World>& world);
    void publish(const Film& film, const World& world, int samples, int all, bool is_finished);
    void publish_error(const std::string& error);

    const Load load_;
    const Settings settings_;

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_, framed_;
    bool end_ = false, is_scene_asked_ = true, is_camera_asked_ = false, wires_ = false;
    std::map<std::string, std::string> parameters_;
    std::optional<Camera> camera_;
    std::shared_ptr<const World> world_;
    std::shared_ptr<const LiveFrame> frame_;
    std::shared_ptr<const Film> film_;
    int film_samples_ = 0, scenes_ = 0;
    std::atomic<bool> cancel_{false};
    BspStore bsps_;                 // BSPs of the last scene, reused where it did not change
    double seconds_per_pixel_ = 0;  // time of a preview; 0: not known yet
    std::thread thread_;
};

}  // namespace deburr
