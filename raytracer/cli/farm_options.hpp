// Options that distribute one picture or animation over several machines, and the default number of threads.
#pragma once
#include <string>
#include <string_view>

#include "raytracer/render/pixel_sums.hpp"

namespace deburr {

/// A share of a picture's rows: number `index`, from 0, of `count`.
struct TileShare {
    int index = 0, count = 1;
};

/// Parses "i/N", "auto" or "auto/N"; for auto, the environment of an array job gives the rest: Slurm's
/// SLURM_ARRAY_TASK_ID and _COUNT, counted from SLURM_ARRAY_TASK_MIN; Kubernetes' JOB_COMPLETION_INDEX; OpenCue's
/// CUE_IFRAME. Throws UsageError.
TileShare parse_tile(std::string_view option, std::string_view text);

/// Parses "a-b": the samples a … b − 1. Throws UsageError.
SampleRange parse_samples(std::string_view option, std::string_view text);

/// The frames first … last of an animation with `count` frames, counted from 1.
struct FrameRange {
    int first = 1, last = 1, count = 1;

    /// The time of a frame: 0 for the first one, increasing to less than 1, so that the animation can be cyclic.
    double time(int frame) const { return double(frame - 1) / count; }
};

/// Parses "a-b" (of b frames), "a-b/N", or "auto/N", where the environment gives the frame, counted from 0. Throws
/// UsageError.
FrameRange parse_frames(std::string_view option, std::string_view text);

/// The path with its last run of '#' replaced by the frame's number, padded with zeros to the run's length. Throws
/// UsageError if there is no '#'.
std::string numbered(std::string_view option, const std::string& path, int frame);

/// The share's rows of a window. Throws UsageError if the window has fewer rows than there are shares.
Window share_of(std::string_view option, const TileShare& share, const Window& window);

/// The number of processors that the process's control group and all groups above it allow; none if there is no quota.
/// `root` is where groups are mounted, `groups_file` names the process's group as /proc/self/cgroup does.
std::optional<double> control_group_quota(const std::string& root, const std::string& groups_file);

/// The default number of threads: the least of SLURM_CPUS_PER_TASK, the quota of the process's control group, and the
/// number of processors that it may use.
int default_threads();

}  // namespace deburr
