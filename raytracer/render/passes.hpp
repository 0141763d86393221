// A picture in passes: sums of samples that grow evenly all over a window.
//
// What comes out after n samples depends on n alone: not on tiles, threads, crops, pauses, nor on where a run ended and
// another took its state over. While a pass is under way, the film holds what all pixels have.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "raytracer/render/integrator.hpp"
#include "raytracer/render/render_tiles.hpp"

namespace deburr {

/// Everything that has been summed up. Its arrays hold the window row by row; the window of a picture with a noise
/// bound is whole cells.
struct PassState {
    SampleRange samples;  // all that are to be taken
    Window window;
    LargeVector<PixelSums> sums;
    std::vector<LayerSums> layers;  // empty: none are kept
    std::vector<ColorSum> halves;   // empty: no noise bound
    std::vector<int> taken;         // of each tile: all samples before this one
};

class Passes {
public:
    struct Settings {
        int width = 0, height = 0;  // of the whole picture
        Window window;              // that the film holds
        std::vector<ImageLayer> layers;
        SampleRange samples;
        double noise = 0;   // > 0: as RenderSettings has it
        int max_pass = 32;  // samples of a pass at most: with fewer, tiles in hand are sooner done
    };

    /// `integrator` shares in the ownership of all that it uses: abandoned tiles go on with it.
    Passes(const Settings& settings, std::shared_ptr<const Integrator> integrator);
    ~Passes();
    Passes(Passes&&) noexcept;

    /// Takes the rest of the pass under way, or the next one; `done` is told of pixels times samples. After a pause it
    /// can be called again, after tiles were abandoned it cannot.
    TilesEnd go_on(const std::atomic<bool>& stop, const Pause& pause, const PixelsDone& done,
                   std::chrono::milliseconds grace);

    bool finished() const;
    /// Samples that all pixels have; 0 while the first pass is under way.
    int samples_of_all() const;
    /// Pixels of the film that have any.
    std::int64_t pixels_begun() const;
    /// Of samples_of_all(); while that is 0, of pixels that have the first one, and the others are empty.
    /// film.complete says whether it is finished(). The reference holds, but not what it shows, until passes go on.
    const Film& film() const;
    TraceCounters counters() const;

    /// Pixels times samples that are taken, of pixels() times samples in all; those that a quiet cell does without
    /// count as taken.
    double work_done() const;
    double work() const;

    /// Everything that has been summed up, as bytes for restore() of passes with the same settings by the same program,
    /// while no pass is going on.
    std::string bytes() const;
    /// Takes over what bytes() gave; false where it cannot have, and then nothing has changed.
    bool restore(std::string_view bytes);

    /// The sums of the film's pixel i; layers where some are kept.
    const PixelSums& sums_at(std::size_t i) const;
    const LayerSums& layers_at(std::size_t i) const;

    /// Memory for a pixel.
    static double bytes_per_pixel(const Settings& settings);

private:
    struct Store;
    std::shared_ptr<Store> store_;
};

}  // namespace deburr
