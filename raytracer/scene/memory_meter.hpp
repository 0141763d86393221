// What a run of a scene may hold in memory: one sum for the interpreter's blocks and for what C++ makes of Lua's
// values.
//
// Sizes are those that malloc hands out, not those that are asked for, so that many small values cost what they take.
#pragma once
#include <cstddef>
#include <exception>

namespace deburr {

/// Thrown where C++ would hold more than is left.
struct MemorySpent : std::exception {
    const char* what() const noexcept override { return "the scene's memory is spent"; }
};

/// Bytes that an allocation of `size` bytes takes.
constexpr std::size_t block_bytes(std::size_t size) { return (size + 8 + 15) / 16 * 16; }

class MemoryMeter {
public:
    explicit MemoryMeter(std::size_t limit) : limit_(limit) {}

    /// False, and nothing is taken, where there is less left.
    bool try_take(std::size_t bytes) {
        if (bytes > limit_ - used_) return false;
        used_ += bytes;
        return true;
    }
    /// Throws MemorySpent where there is less left.
    void take(std::size_t bytes) {
        if (!try_take(bytes)) throw MemorySpent();
    }
    void give_back(std::size_t bytes) { used_ -= bytes; }

    /// Takes a text's characters, if they need memory of their own.
    void take_text(std::size_t size) {
        constexpr std::size_t within_the_object = 15;
        if (size > within_the_object) take(block_bytes(size + 1));
    }

    std::size_t used() const { return used_; }

private:
    std::size_t limit_, used_ = 0;
};

}  // namespace deburr
