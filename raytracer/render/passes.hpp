// Renders a picture in passes over a window, each of which adds samples to all pixels.
//
// The result after n samples depends on n only: not on tiles, threads, crops, pauses, nor on where one run ended and
// another continued from its state. While a pass is under way, the film shows the samples that all pixels have.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"

namespace deburr {

/// The state of a rendering: all sums. Its arrays hold the window row by row; with a noise bound the window consists of
/// whole cells.
struct PassState {
    SampleRange samples;  // all samples that are to be taken
    Window window;
    LargeVector<PixelSums> sums;
    std::vector<LayerSums> layers;  // empty: no layers are kept
    std::vector<ColorSum> halves;   // colour sums of the first half of the samples; empty: no noise bound
    std::vector<int> taken;         // of each tile: the samples before this one are taken
};

/// A rendering in progress.
class Passes {
public:
    /// What is rendered, and in which passes.
    struct Settings {
        int width = 0, height = 0;  // of the whole picture
        Window window;              // that the film shows
        std::vector<ImageLayer> layers;
        SampleRange samples;
        double noise = 0;   // > 0: see RenderSettings::noise
        int max_pass = 32;  // most samples of a pass; fewer let the tiles in hand end sooner
    };

    /// `integrator` must share the ownership of all that it uses, since abandoned tiles continue to use it.
    Passes(const Settings& settings, std::shared_ptr<const Integrator> integrator);
    ~Passes();
    Passes(Passes&&) noexcept;

    /// Continues the pass under way, or begins the next one; `done` is told pixels times samples. It can be called
    /// again after a pause, but not after tiles were abandoned.
    TilesEnd go_on(const std::atomic<bool>& stop, const Pause& pause, const PixelsDone& done,
                   std::chrono::milliseconds grace);

    /// Whether all samples are taken.
    bool finished() const;
    /// The number of samples that all pixels have; 0 during the first pass.
    int samples_of_all() const;
    /// The number of the film's pixels that have samples.
    std::int64_t pixels_begun() const;
    /// The picture with samples_of_all() samples; during the first pass, of the pixels that have the first sample, with
    /// the others empty. film.complete is finished(). The reference stays valid, but its content changes when passes
    /// continue.
    const Film& film() const;
    TraceCounters counters() const;

    /// The work done and the whole work, in pixels times samples; samples that a quiet cell does not need count as
    /// done.
    double work_done() const;
    double work() const;

    /// The state as bytes for restore() by passes with the same settings in the same program. Must not be called during
    /// a pass.
    std::string bytes() const;
    /// Restores the state from bytes(). False, and nothing changes, if the bytes do not fit these settings.
    bool restore(std::string_view bytes);

    /// The sums of the film's pixel i; layers only if some are kept.
    const PixelSums& sums_at(std::size_t i) const;
    const LayerSums& layers_at(std::size_t i) const;

    /// Memory for each pixel.
    static double bytes_per_pixel(const Settings& settings);

private:
    struct Store;
    std::shared_ptr<Store> store_;
};

}  // namespace deburr
