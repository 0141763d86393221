#include "raytracer/cli/farm_options.hpp"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "raytracer/cli/option_values.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

// Most shares: no picture has more rows.
constexpr int most_shares = largest_picture_side;

std::optional<int> environment_number(const char* name) {
    const char* text = std::getenv(name);
    if (!text || !*text) return std::nullopt;
    return int(parse_whole(name, text, 0, most_shares));
}

int number_in_array(std::string_view option) {
    if (const auto id = environment_number("SLURM_ARRAY_TASK_ID"))
        return *id - environment_number("SLURM_ARRAY_TASK_MIN").value_or(0);
    for (const char* name : {"JOB_COMPLETION_INDEX", "CUE_IFRAME"})
        if (const auto index = environment_number(name)) return *index;
    throw UsageError(fmt::format(
        "{}: expected SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX or CUE_IFRAME in the environment, got none", option));
}

int count_of_array(std::string_view option) {
    if (const auto count = environment_number("SLURM_ARRAY_TASK_COUNT")) return *count;
    throw UsageError(
        fmt::format("{}: expected auto/N where the environment has no SLURM_ARRAY_TASK_COUNT, got auto", option));
}

// The quota of a folder of the unified hierarchy (cgroup v2), in processors.
std::optional<double> quota_in(const std::string& folder) {
    std::ifstream file(folder + "/cpu.max");
    std::string quota;
    double period = 0;
    if (!(file >> quota >> period) || quota == "max" || !(period > 0)) return std::nullopt;
    return std::atof(quota.c_str()) / period;
}

}  // namespace

std::optional<double> control_group_quota(const std::string& root, const std::string& groups_file) {
    std::optional<double> least;
    const auto take = [&](std::optional<double> quota) {
        if (quota && *quota > 0) least = std::min(least.value_or(*quota), *quota);
    };
    take(quota_in(root));
    std::ifstream groups(groups_file);
    for (std::string line; std::getline(groups, line);) {
        if (line.rfind("0::/", 0) != 0) continue;
        for (std::string path = line.substr(3); path.size() > 1; path = path.substr(0, path.rfind('/')))
            take(quota_in(root + path));
    }
    // The quota of cgroup v1.
    std::ifstream quota(root + "/cpu/cpu.cfs_quota_us"), period(root + "/cpu/cpu.cfs_period_us");
    double q = 0, p = 0;
    if (quota >> q && period >> p && q > 0 && p > 0) take(q / p);
    return least;
}

TileShare parse_tile(std::string_view option, std::string_view text) {
    const std::size_t slash = text.find('/');
    const std::string_view first = text.substr(0, slash);
    if (slash == std::string_view::npos && first != "auto")
        throw UsageError(fmt::format("{}: expected i/N, auto or auto/N, got '{}'", option, text));
    TileShare share;
    share.count = slash == std::string_view::npos ? count_of_array(option)
                                                  : int(parse_whole(option, text.substr(slash + 1), 1, most_shares));
    share.index =
        first == "auto" ? number_in_array(option) : int(parse_whole(option, first, 0, std::int64_t(share.count) - 1));
    if (share.index < 0 || share.index >= share.count)
        throw UsageError(fmt::format("{}: expected a number from 0 to {} in the environment, got {}", option,
                                     share.count - 1, share.index));
    return share;
}

SampleRange parse_samples(std::string_view option, std::string_view text) {
    const std::size_t dash = text.find('-');
    if (dash == std::string_view::npos)
        throw UsageError(fmt::format("{}: expected a-b, samples a to b-1, got '{}'", option, text));
    SampleRange range;
    range.first = int(parse_whole(option, text.substr(0, dash), 0, max_samples - 1));
    range.end = int(parse_whole(option, text.substr(dash + 1), range.first + 1, max_samples));
    return range;
}

FrameRange parse_frames(std::string_view option, std::string_view text) {
    constexpr int most = 1'000'000;
    const std::size_t slash = text.find('/');
    const std::string_view range = text.substr(0, slash);
    FrameRange frames;
    if (slash != std::string_view::npos) frames.count = int(parse_whole(option, text.substr(slash + 1), 1, most));
    if (range == "auto" && slash != std::string_view::npos) {
        frames.first = frames.last = number_in_array(option) + 1;
        if (frames.last > frames.count)
            throw UsageError(fmt::format("{}: expected a number from 0 to {} in the environment, got {}", option,
                                         frames.count - 1, frames.last - 1));
        return frames;
    }
    const std::size_t dash = range.find('-');
    if (dash == std::string_view::npos)
        throw UsageError(fmt::format("{}: expected a-b, a-b/N or auto/N, got '{}'", option, text));
    frames.first = int(parse_whole(option, range.substr(0, dash), 1, most));
    frames.last = int(parse_whole(option, range.substr(dash + 1), frames.first,
                                  slash == std::string_view::npos ? most : frames.count));
    if (slash == std::string_view::npos) frames.count = frames.last;
    return frames;
}

std::string numbered(std::string_view option, const std::string& path, int frame) {
    const std::size_t end = path.rfind('#');
    if (end == std::string::npos)
        throw UsageError(fmt::format("{}: expected names with # for the frame's number, got '{}'", option, path));
    const std::size_t before = path.find_last_not_of('#', end);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return path.substr(0, begin) + fmt::format("{:0{}}", frame, end + 1 - begin) + path.substr(end + 1);
}

Window share_of(std::string_view option, const TileShare& share, const Window& w) {
    if (w.height < share.count)
        throw UsageError(fmt::format("{}: expected at most one share for each of the {} rows, got {}", option, w.height,
                                     share.count));
    const auto row = [&](std::int64_t i) { return int(w.height * i / share.count); };
    return {w.x, w.y + row(share.index), w.width, row(share.index + 1) - row(share.index)};
}

int default_threads() {
    int threads = tbb::info::default_concurrency();
    if (const char* text = std::getenv("SLURM_CPUS_PER_TASK"))
        if (const int given = std::atoi(text); given > 0) threads = std::min(threads, given);
    if (const auto quota = control_group_quota("/sys/fs/cgroup", "/proc/self/cgroup"))
        threads = std::min(threads, std::max(1, int(std::ceil(*quota))));
    return threads;
}

}  // namespace deburr
