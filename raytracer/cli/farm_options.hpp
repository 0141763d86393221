// Options by which one picture is shared among machines.
#pragma once
#include <string>
#include <string_view>

#include "raytracer/render/pixel_sums.hpp"

namespace deburr {

/// One of `count` shares of a picture's rows.
struct TileShare {
    int index = 0, count = 1;
};

/// "i/N", "auto" or "auto/N", of which the environment of a job's array says the rest: Slurm's SLURM_ARRAY_TASK_ID and
/// _COUNT, counted from SLURM_ARRAY_TASK_MIN; Kubernetes' JOB_COMPLETION_INDEX; OpenCue's CUE_IFRAME. Throws
/// UsageError.
TileShare parse_tile(std::string_view option, std::string_view text);

/// "a-b": samples a to b - 1. Throws UsageError.
SampleRange parse_samples(std::string_view option, std::string_view text);

/// Frames `first` to `last` of an animation of `count`, which are counted from 1.
struct FrameRange {
    int first = 1, last = 1, count = 1;

    /// From 0 for the first frame to what is less than 1, so that the animation can run in a circle.
    double time(int frame) const { return double(frame - 1) / count; }
};

/// "a-b", of b frames, "a-b/N", or "auto/N", of which the environment says the number, from 0. Throws UsageError.
FrameRange parse_frames(std::string_view option, std::string_view text);

/// The name with the last run of '#' replaced by the frame's number, with as many digits at least; throws UsageError
/// where there is none.
std::string numbered(std::string_view option, const std::string& path, int frame);

/// Those rows of a window; throws UsageError if it has fewer rows than there are shares.
Window share_of(std::string_view option, const TileShare& share, const Window& window);

/// Processors that the control group of a process may use, and every group around it: none if there is no quota.
/// `root`: where groups are mounted; `groups_file`: what says which group it is, as /proc/self/cgroup.
std::optional<double> control_group_quota(const std::string& root, const std::string& groups_file);

/// Threads by default: SLURM_CPUS_PER_TASK, or the quota of the process's control group, or as many as there are
/// processors that it may use, whichever is least.
int default_threads();

}  // namespace deburr
