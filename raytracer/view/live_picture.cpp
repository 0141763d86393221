#include "raytracer/view/live_picture.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "raytracer/image/image_file.hpp"
#include "raytracer/mesh/mesh_tracer.hpp"
#include "raytracer/mesh/scene_mesh.hpp"
#include "raytracer/render/passes.hpp"
#include "raytracer/render/sample_count.hpp"
#include "raytracer/trace/implicit_tracer.hpp"

namespace deburr {
namespace {

using Clock = std::chrono::steady_clock;

// Longest time of a preview in seconds: 20 pictures a second, with the time that the page needs.
constexpr double preview_seconds = 0.04;
// A picture is refined once nothing has been requested for this long, since a drag pauses between its steps.
constexpr std::chrono::milliseconds calm(120);
constexpr double wire_width = 1;  // pixels
constexpr int least_shown = 8;    // samples
// Most samples of a pass: a tile of it takes a few milliseconds, which a moving camera has to wait for.
constexpr int max_pass = 2;
// Least time between refined pictures in seconds, since sending and painting a large one takes time.
constexpr double seconds_of_show = 0.15;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string rgba_of(const Film& film, double exposure, ViewTransform view) {
    const double scale = std::exp2(exposure);
    std::string bytes(film.pixels.size() * 4, '\xff');
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        Vec3 light = scale * film.pixels[i].color;
        if (view != ViewTransform::standard) light = displayed(view, light);
        for (int k = 0; k < 3; ++k) bytes[4 * i + std::size_t(k)] = char(srgb_byte(light[k]));
    }
    return bytes;
}

}  // namespace

// A scene with its tracer, which is shared by worlds that differ in the camera only.
struct LivePicture::World {
    Scene scene;    // with the camera that it is seen by
    Camera camera;  // the scene's own
    std::shared_ptr<const RayTracer> tracer;
    std::shared_ptr<const SceneMesh> wires;  // the mesh whose wires are drawn; null: none
    std::shared_ptr<const RayTracer> wire_tracer;
    std::optional<Integrator> integrator;
    int number = 0;
};

LivePicture::LivePicture(Load load, const Settings& settings) : load_(std::move(load)), settings_(settings) {
    thread_ = std::thread([this] { run(); });
}

LivePicture::~LivePicture() {
    {
        const std::lock_guard lock(mutex_);
        end_ = cancel_ = true;
    }
    changed_.notify_all();
    framed_.notify_all();
    thread_.join();
}

std::shared_ptr<const LiveFrame> LivePicture::wait_for_frame(int after, std::chrono::milliseconds time) const {
    std::unique_lock lock(mutex_);
    framed_.wait_for(lock, time, [&] { return end_ || (frame_ && frame_->number > after); });
    return frame_ && frame_->number > after ? frame_ : nullptr;
}

void LivePicture::reload() {
    {
        const std::lock_guard lock(mutex_);
        is_scene_asked_ = cancel_ = true;
    }
    changed_.notify_all();
}

void LivePicture::set_parameters(const std::map<std::string, std::string>& parameters) {
    {
        const std::lock_guard lock(mutex_);
        parameters_ = parameters;
        is_scene_asked_ = cancel_ = true;
    }
    changed_.notify_all();
}

void LivePicture::set_camera(const std::optional<Camera>& camera) {
    {
        const std::lock_guard lock(mutex_);
        camera_ = camera;
        is_camera_asked_ = cancel_ = true;
    }
    changed_.notify_all();
}

void LivePicture::show_wires(bool shown) {
    {
        const std::lock_guard lock(mutex_);
        wires_ = shown;
        is_scene_asked_ = cancel_ = true;
    }
    changed_.notify_all();
}

std::shared_ptr<const Scene> LivePicture::scene() const {
    const std::lock_guard lock(mutex_);
    return world_ ? std::shared_ptr<const Scene>(world_, &world_->scene) : nullptr;
}

std::optional<PickedSurface> LivePicture::pick(double x, double y) const {
    std::shared_ptr<const World> world;
    {
        const std::lock_guard lock(mutex_);
        world = world_;
    }
    if (!world) return std::nullopt;
    const ProjectiveCamera camera(world->scene.camera, world->scene.width, world->scene.height);
    TraceCounters counters;
    const Hit hit = world->tracer->closest_hit(camera.ray(x, y), infinity, counters);
    if (!hit) return std::nullopt;
    return PickedSurface{hit.solid, hit.material, hit.position, hit.normal};
}

std::shared_ptr<const Film> LivePicture::film(int& samples) const {
    const std::lock_guard lock(mutex_);
    samples = film_samples_;
    return film_;
}

void LivePicture::publish(const Film& film, const World& world, int samples, int all, bool is_finished) {
    auto frame = std::make_shared<LiveFrame>();
    frame->width = film.window.width;
    frame->height = film.window.height;
    const Film* shown = &film;
    Film with_wires;
    if (world.wires && film.window.width == world.scene.width) {
        with_wires = film;
        const ProjectiveCamera camera(world.scene.camera, film.width, film.height);
        draw_strokes(with_wires,
                     wire_frame(world.wires->mesh, mesh_edges(world.wires->mesh, EdgeChoice::polygons),
                                *world.wire_tracer, camera, film.window, WireMode::visible),
                     Vec3(0.0), wire_width);
        shown = &with_wires;
    }
    frame->rgba = rgba_of(*shown, world.scene.exposure, settings_.view);
    frame->samples = samples;
    frame->all_samples = all;
    frame->is_finished = is_finished;
    frame->scene = world.number;
    const bool is_whole = film.window.width == world.scene.width;
    auto kept = is_whole ? std::make_shared<Film>(film) : nullptr;
    {
        const std::lock_guard lock(mutex_);
        frame->number = frame_ ? frame_->number + 1 : 1;
        frame_ = std::move(frame);
        if (is_whole) {
            film_ = std::move(kept);
            film_samples_ = std::max(samples, 1);
        }
    }
    framed_.notify_all();
}

// Publishes the last picture again, with an error.
void LivePicture::publish_error(const std::string& error) {
    {
        const std::lock_guard lock(mutex_);
        auto frame = frame_ ? std::make_shared<LiveFrame>(*frame_) : std::make_shared<LiveFrame>();
        ++frame->number;
        frame->error = error;
        frame_ = std::move(frame);
    }
    framed_.notify_all();
}

bool LivePicture::read_scene() {
    std::map<std::string, std::string> parameters;
    bool wires = false;
    std::optional<Camera> camera;
    {
        const std::lock_guard lock(mutex_);
        parameters = parameters_;
        wires = wires_;
        camera = camera_;
    }
    auto world = std::make_shared<World>();
    try {
        world->scene = load_(parameters);
        world->tracer = std::make_shared<ImplicitTracer>(world->scene.solids, Criterion::exact,
                                                         RootMethod::where_needed, Accel::bvh, &bsps_);
        if (wires) {
            MeshSettings settings = picture_mesh_settings();
            settings.leave_out_unbounded = true;
            auto mesh = std::make_shared<SceneMesh>(mesh_scene(world->scene, settings));
            world->wire_tracer = std::make_shared<MeshTracer>(mesh->mesh, mesh->near);
            world->wires = std::move(mesh);
        }
    } catch (const std::bad_alloc&) {
        publish_error("out of memory");
        return false;
    } catch (const std::exception& error) {
        publish_error(error.what());
        return false;
    }
    world->camera = world->scene.camera;
    if (camera) world->scene.camera = *camera;
    const std::lock_guard lock(mutex_);
    world->number = ++scenes_;
    world_ = std::move(world);
    return true;
}

void LivePicture::show_preview(const std::shared_ptr<const World>& world, int coarseness, bool may_be_cut) {
    const Clock::time_point begin = Clock::now();
    const int width = std::max(1, world->scene.width / coarseness);
    const int height = std::max(1, world->scene.height / coarseness);
    RenderSettings settings{width, height, 1, 0, false};
    const Integrator integrator(world->scene, *world->tracer, settings);
    // A preview that answers a step of a drag is never cancelled, or a quick drag would show nothing.
    const std::atomic<bool> never{false};
    const Rendering rendering = render(
        Film(width, height, {0, 0, width, height}),
        [&](const Window& block, Pixel* pixels, PixelLayers* layers, TraceCounters& counters) {
            integrator.block(block, pixels, layers, counters);
        },
        may_be_cut ? cancel_ : never);
    if (!rendering.film.complete) return;
    publish(rendering.film, *world, 0, 0, false);
    seconds_per_pixel_ = seconds_since(begin) / (double(width) * height);
}

void LivePicture::refine(const std::shared_ptr<const World>& world) {
    const Scene& scene = world->scene;
    RenderSettings settings{scene.width, scene.height, settings_.spp.value_or(scene.spp.value_or(0)), 0, false};
    if (settings.spp == 0)
        settings.spp = sample_count(scene, *world->tracer, settings, scene.exposure, &cancel_).samples;
    if (cancel_) return;
    if (settings.spp == 1) return publish(*film_, *world, 1, 1, true);  // the preview is the picture
    const auto traced = std::make_shared<World>(*world);
    traced->integrator.emplace(traced->scene, *traced->tracer, settings);
    Passes passes({scene.width, scene.height, {0, 0, scene.width, scene.height}, {}, {0, settings.spp}, 0, max_pass},
                  std::shared_ptr<const Integrator>(traced, &*traced->integrator));
    Clock::time_point shown = Clock::now();
    while (!passes.finished()) {
        // Waiting for tiles that are being rendered takes a few milliseconds and loses no work.
        passes.go_on(cancel_, {}, {}, std::chrono::hours(1));
        if (cancel_) return;
        // With fewer samples the picture is noisier than the preview, which has no noise.
        if (passes.samples_of_all() < least_shown && !passes.finished()) continue;
        if (seconds_since(shown) < seconds_of_show && !passes.finished()) continue;
        shown = Clock::now();
        publish(passes.film(), *world, passes.samples_of_all(), settings.spp, passes.finished());
    }
}

void LivePicture::run() {
    bool is_refined = false;
    while (true) {
        bool is_read = false, is_moved = false;
        {
            std::unique_lock lock(mutex_);
            const auto is_asked = [&] { return end_ || is_scene_asked_ || is_camera_asked_; };
            if (!world_ || is_refined)
                changed_.wait(lock, is_asked);
            else
                changed_.wait_for(lock, calm, is_asked);
            if (end_) return;
            is_read = is_scene_asked_;
            is_moved = is_camera_asked_;
            is_scene_asked_ = is_camera_asked_ = cancel_ = false;
            if (is_moved && !is_read && world_) {
                auto world = std::make_shared<World>(*world_);
                world->scene.camera = camera_.value_or(world->camera);
                world_ = std::move(world);
            }
        }
        if (is_read || (is_moved && !scene())) {
            if (!read_scene()) {
                is_refined = true;
                continue;
            }
        }
        const std::shared_ptr<const World> world = [&] {
            const std::lock_guard lock(mutex_);
            return world_;
        }();
        if (is_read || is_moved) {
            const double whole = seconds_per_pixel_ * world->scene.width * world->scene.height;
            const int coarseness = whole > 0 ? std::clamp(int(std::ceil(std::sqrt(whole / preview_seconds))), 1, 8) : 4;
            show_preview(world, coarseness, false);
            is_refined = false;
            if (coarseness == 1 || is_moved) continue;
        }
        if (is_read || !is_refined) {
            if (!cancel_) show_preview(world, 1, true);
            if (!cancel_) refine(world);
            is_refined = !cancel_;
        }
    }
}

}  // namespace deburr
