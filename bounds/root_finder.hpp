// Roots of f(t) = ρ(o + t·d) − ½ on a ray segment.
#pragma once

namespace deburr {

/// When a segment counts as holding at most one root.
enum class Criterion { exact, lobb };

}  // namespace deburr
