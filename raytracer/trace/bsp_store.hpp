// Keeps the BSPs of one scene for the next, so that those of unchanged parts are not built again.
//
// The store serves scenes that are edited while they are shown (`deburr view`). Solids count as unchanged if they are
// equal in shape, placement and material (canonical_solids.hpp), even if their file was read again.
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "bounds/canonical_solids.hpp"
#include "raytracer/trace/bsp_tree.hpp"

namespace deburr {

/// The BSPs of the current scene and of the last one.
class BspStore {
public:
    /// Begins a scene: BSPs that the last one did not use are dropped.
    void begin_scene();

    /// Returns what build_bsp() returns for these arguments, to the bit. Thread-safe.
    BspTree bsp(const std::vector<Solid>& solids, RootMethod root_method, double min_scale);

    /// The number of BSPs in this scene that were kept from the last one, and of those that were built.
    std::size_t kept() const { return kept_; }
    std::size_t built() const { return built_; }

private:
    // A BSP with the arguments that it was built from.
    struct Entry {
        std::vector<Solid> solids;
        RootMethod root_method;
        double min_scale;
        std::shared_ptr<const BspTree> tree;
        bool is_used = true;  // whether this scene has asked for it
    };
    std::string key(const std::vector<Solid>& solids, RootMethod root_method);
    static bool fits(const Entry& entry, double min_scale);

    std::mutex mutex_;
    std::unordered_map<std::string, Entry> entries_;
    std::vector<std::vector<Solid>> asked_for_;  // kept alive because canonical_ refers to them by address
    std::unique_ptr<CanonicalSolids> canonical_ = std::make_unique<CanonicalSolids>();
    std::size_t kept_ = 0, built_ = 0;
};

}  // namespace deburr
