// Limits the memory of a scene's run: one sum for the interpreter's blocks and for what C++ makes of Lua's values.
//
// Sizes are those that malloc really uses, not those requested, so that many small values count in full.
#pragma once
#include <cstddef>
#include <exception>

namespace deburr {

/// Thrown where C++ would need more memory than is left.
struct MemorySpent : std::exception {
    const char* what() const noexcept override { return "the scene's memory is spent"; }
};

/// The bytes that malloc uses for an allocation of `size` bytes.
constexpr std::size_t block_bytes(std::size_t size) { return (size + 8 + 15) / 16 * 16; }

/// The sum of the bytes in use, up to a limit.
class MemoryMeter {
public:
    explicit MemoryMeter(std::size_t limit) : limit_(limit) {}

    /// Adds `bytes`; false, and nothing added, if less is left.
    bool try_take(std::size_t bytes) {
        if (bytes > limit_ - used_) return false;
        used_ += bytes;
        return true;
    }
    /// Adds `bytes`; throws MemorySpent if less is left.
    void take(std::size_t bytes) {
        if (!try_take(bytes)) throw MemorySpent();
    }
    void give_back(std::size_t bytes) { used_ -= bytes; }

    /// Adds the memory of a std::string of this size; none if its characters fit into the object.
    void take_text(std::size_t size) {
        constexpr std::size_t within_the_object = 15;
        if (size > within_the_object) take(block_bytes(size + 1));
    }

    std::size_t used() const { return used_; }

private:
    std::size_t limit_, used_ = 0;
};

}  // namespace deburr
