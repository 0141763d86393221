// Pictures that end where little noise is left.
//
// The cells of an even grid over the whole picture, 8 pixels wide, each end by themselves: when two halves of their
// samples are alike [Dammertz et al., A Hierarchical Automatic Stopping Condition, 2010]. It is decided at powers of
// two only, so that the picture does not depend on how samples are parted into passes; and a part of a cell is
// rendered as all of it, so that no pixel depends on a crop.
#pragma once
#include "raytracer/render/integrator.hpp"

namespace deburr {

/// The least window of whole cells around this one, within a picture of this size.
Window grown_to_cells(const Window& window, int width, int height);

/// Takes a pass, one of next_pass(), of a window of whole cells: of those that are not quiet yet. `noise` is the root
/// of the mean square, as a display shows it, that is left when a cell ends.
void take_until_quiet(const Integrator& integrator, double noise, SampleRange pass, const Window& window,
                      const SampleArrays& arrays, TraceCounters& counters);

}  // namespace deburr
