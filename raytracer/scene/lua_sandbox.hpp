// Runs a scene's Lua program with limited memory, work, time and output.
//
// A run that exceeds its budget is abandoned, not interrupted by a Lua error: control jumps out of the interpreter, its
// state is never entered again, and its memory is freed as a whole. So there is nothing that pcall, xpcall, coroutines,
// __close or error handlers could catch or prolong. Finalizers, which Lua runs with hooks disabled, are refused when
// they are set.
//
// Work inside a single call of a library function is charged in advance, and allocation by the byte. Not promised: the
// exact line at which memory or time ran out; the message names the line of the latest sample.
//
// Time is limited from outside: the interpreter runs on a thread of its own, and run() waits for it no longer than the
// limit. A hook, an allocation or a library function that finds the time over abandons the run at once. Where none of
// these is reached, as in a comparison of long texts or in the parser, run() still throws and leaves the thread behind.
// That thread then touches only its own state, and ends at the next hook, allocation or library function.
//
// The interpreter is compiled as C, so its errors are longjmp. A function registered in prepare() must therefore hold
// no object with a destructor when it calls a Lua function that can raise.
#pragma once
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "raytracer/scene/memory_meter.hpp"
#include "raytracer/util/scene_error.hpp"

struct lua_State;

namespace deburr {

/// The limits of one run.
struct SandboxLimits {
    std::size_t memory = std::size_t(256) << 20;  // bytes
    std::int64_t work = 500'000'000;              // instructions, and other work in equivalent instructions
    double seconds = 20.0;                        // wall-clock time, whatever the work
    std::size_t output = std::size_t(1) << 20;    // bytes printed
    // Bytes of the objects that a scene makes and of their expressions' nodes, none of which is freed before the end. A
    // scene may be larger than the memory that describes it: three million placements take 600 MB.
    std::size_t parts = std::size_t(640) << 20;
    bool mute = false;  // whether output is counted but not printed
};

/// An interpreter for one run.
class Sandbox {
public:
    /// Called when the state and its library are ready. May raise Lua errors.
    using Prepare = void (*)(lua_State*);

    /// `host` is passed to the functions that prepare() registers (HostCall); it must outlive the run.
    explicit Sandbox(SandboxLimits limits = {}, void* host = nullptr);
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    /// Runs `text` once. The first result is at index 1 of the returned state, and may be read by Lua functions that
    /// neither raise nor allocate. `file` names the text in messages. Throws SceneError, and std::bad_alloc if the
    /// system has no memory left, whatever the limit.
    lua_State* run(std::string text, const std::string& file, Prepare prepare = nullptr);

    /// The meter shared by the interpreter and the host. Must not be used by another thread while run() runs.
    MemoryMeter& memory();
    /// The file of the text and those that the host has added, for places in messages. Must not be used while run()
    /// runs.
    const SourceMap& sources() const;
    /// The message with which run() ends when memory() is used up, without the place.
    std::string memory_reason() const;

    /// Instructions between two checks of the budget, counted for each coroutine. A longer interval would gain little:
    /// any count hook makes a loop of additions take 2.2 times as long.
    static constexpr int sample_interval = 1000;

    /// Charges work to the budget; does not return if the budget or the time is used up. No object with a destructor
    /// may be on the stack.
    static void spend(lua_State* lua, std::int64_t work);
    /// Prints the values at stack indices first … last as a line on stderr; does not return if that exceeds the limit
    /// of output.
    static void print(lua_State* lua, int first, int last);

private:
    friend class HostCall;
    friend const void* host_of(lua_State* lua);
    struct State;
    std::shared_ptr<State> state_;
};

/// Whether a call of the host must end the run: its limit of memory is used up (spent), or the system has no memory
/// (none).
enum class Memory { enough, spent, none };

/// The time during which a function registered by prepare() runs host code. Meanwhile run() does not return, and an
/// allocation by Lua fails instead of abandoning the run, so objects with destructors may exist.
class HostCall {
public:
    /// Begins host code; does not return if time is up.
    static HostCall enter(lua_State* lua);
    /// Ends host code and charges its work; does not return if a budget is used up.
    void leave(std::int64_t work, Memory memory) const;

    void* host;
    MemoryMeter* memory;
    SourceMap* sources;
    std::int64_t work_left;

private:
    HostCall(void* of_host, MemoryMeter* of_memory, SourceMap* of_sources, std::int64_t work, lua_State* lua)
        : host(of_host), memory(of_memory), sources(of_sources), work_left(work), lua_(lua) {}
    lua_State* lua_;
};

/// The interpreter's host, for reading only.
const void* host_of(lua_State* lua);

/// The line of the scene that is being executed; 0 if there is none.
int current_line(lua_State* lua);

}  // namespace deburr
