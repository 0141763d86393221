// A scene's picture while it is being looked at: coarse at once, then sharp, then in passes to the end.
//
// A thread of its own does the work. Whatever changes, the scene's file, a parameter, the camera, cancels the passes
// under way, and the next frame is of what is asked for last. What the passes end with is the picture of `deburr
// render`. Frames hold values as a display shows them.
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

/// A picture as it was shown at one time.
struct LiveFrame {
    int number = 0;                    // counts from 1
    int width = 0, height = 0;         // of `rgba`, which may be coarser than the picture
    std::string rgba;                  // 8 bit, row by row; the window's page paints it
    int samples = 0, all_samples = 0;  // 0: a preview
    bool is_finished = false;
    std::string error;  // why the scene's file gives none; the picture is then an earlier one's
    int scene = 0;      // counts the scenes that were read
};

/// A surface at a place of the picture.
struct PickedSurface {
    int solid = 0, material = 0;  // indices in the scene's
    Vec3 position, normal;
};

class LivePicture {
public:
    /// Reads the scene with these parameters; throws what is wrong with it.
    using Load = std::function<Scene(const std::map<std::string, std::string>& parameters)>;

    struct Settings {
        std::optional<int> spp;  // none: the scene's, or as many as it takes
        ViewTransform view = ViewTransform::standard;
    };

    /// Begins at once.
    LivePicture(Load load, const Settings& settings);
    ~LivePicture();
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    /// The first frame with a number above this one; null if there is none in time.
    std::shared_ptr<const LiveFrame> wait_for_frame(int after, std::chrono::milliseconds time) const;

    void reload();
    void set_parameters(const std::map<std::string, std::string>& parameters);
    /// None: the scene's own.
    void set_camera(const std::optional<Camera>& camera);
    void show_wires(bool shown);

    /// The scene as it is seen, with the camera; null before the first.
    std::shared_ptr<const Scene> scene() const;
    /// Pixels as the whole picture has them.
    std::optional<PickedSurface> pick(double x, double y) const;
    /// The picture as far as it is; `samples` that its pixels have. Null before the first.
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
    BspStore bsps_;                 // of the last scene
    double seconds_per_pixel_ = 0;  // of a preview; 0: not known yet
    std::thread thread_;
};

}  // namespace deburr
