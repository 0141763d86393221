// Adaptive sampling: rendering ends where little noise is left.
//
// The cells of a regular grid over the whole picture, 8 x 8 pixels, each end by themselves, when two halves of their
// samples agree [Dammertz et al., A Hierarchical Automatic Stopping Condition, 2010]. This is decided at powers of two
// samples only, so that the picture does not depend on how samples are divided into passes; and a cell is always
// rendered whole, so that no pixel depends on a crop.
#pragma once
#include "raytracer/render/integrator.hpp"

namespace deburr {

/// The smallest window of whole cells that contains `window`, within a picture of this size.
Window grown_to_cells(const Window& window, int width, int height);

/// Takes a pass (of next_pass()) for the cells of a window of whole cells that are still noisy. A cell ends when the
/// root mean square of its noise, in display values (0 … 1), is at most `noise`.
void take_until_quiet(const Integrator& integrator, double noise, SampleRange pass, const Window& window,
                      const SampleArrays& arrays, TraceCounters& counters);

}  // namespace deburr
