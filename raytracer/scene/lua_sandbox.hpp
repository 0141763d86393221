// Runs a scene's Lua text with bounded memory, work, time and output.
//
// A run that spends its budget is abandoned, not interrupted by a Lua error: control jumps out of
// the interpreter, nothing of the state is entered again, and its memory goes back as a whole. So
// there is nothing that pcall, xpcall, coroutines, __close or error handlers could catch or prolong.
// Finalizers, which Lua runs with hooks off, are refused where they would be set.
//
// Work inside a single call of a library function is charged to the budget before it is done, and
// allocation by the byte. Not promised: the exact line at which memory or time ran out; it is the
// line of the latest sample.
//
// Time is kept from outside. The interpreter has a thread of its own, and run() waits for it no
// longer than the limit: so it matters little what the interpreter is doing. A hook, an allocation or
// a function of the library that finds time to be up abandons the run at once. Where none of them is
// reached, as in a comparison of long texts or in the parser, run() throws all the same and leaves
// the thread behind. That one touches nothing but its own state from then on, and ends at the next
// hook, allocation or function.
//
// The interpreter is compiled as C: its errors are longjmp. A function registered in prepare() must
// therefore hold no object with a destructor when it calls anything of Lua that can raise.
#pragma once
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "raytracer/scene/memory_meter.hpp"
#include "raytracer/util/scene_error.hpp"

struct lua_State;

namespace deburr {

struct SandboxLimits {
    std::size_t memory = std::size_t(256) << 20;  // bytes
    std::int64_t work = 500'000'000;              // instructions, and what costs about as much
    double seconds = 20.0;                        // by the clock, whatever the work
    std::size_t output = std::size_t(1) << 20;    // bytes printed
    // Bytes of the objects that a scene makes and of their expressions' nodes, none of which is freed before the end.
    // A scene may be larger than what it needs to describe it: three million placements take 600 MB.
    std::size_t parts = std::size_t(640) << 20;
    bool mute = false;  // what is printed counts, and is not shown
};

class Sandbox {
public:
    /// Called with the state ready and the library open. May raise Lua errors.
    using Prepare = void (*)(lua_State*);

    /// `host` is for the functions that prepare() registers; see HostCall.
    explicit Sandbox(SandboxLimits limits = {}, void* host = nullptr);
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    /// Runs `text`, named `file` in messages, once; its first result is at index 1 of the state
    /// that is returned, and may be read with functions of Lua that neither raise nor allocate.
    /// Throws SceneError, and std::bad_alloc where the system has no memory left, whatever the limit.
    lua_State* run(std::string text, const std::string& file, Prepare prepare = nullptr);

    /// Shared by the interpreter and the host. Not to be used by another thread while run() runs.
    MemoryMeter& memory();
    /// The text's file, and those that the host has added, for places in messages. Not to be used while run() runs.
    const SourceMap& sources() const;
    /// The message with which run() ends where memory() is spent, without the place.
    std::string memory_reason() const;

    /// Instructions between two looks at the budget, in each coroutine by itself. A shorter
    /// interval costs little more: any count hook makes a loop of additions take 2.2 times as long.
    static constexpr int sample_interval = 1000;

    /// Charges work to the budget; does not return if that or the time is spent. Call it with no object
    /// with a destructor on the stack.
    static void spend(lua_State* lua, std::int64_t work);
    /// Writes a line to stderr; does not return if that is more than a scene may print.
    static void print(lua_State* lua, int first, int last);

private:
    friend class HostCall;
    friend const void* host_of(lua_State* lua);
    struct State;
    std::shared_ptr<State> state_;
};

/// Why a visit of the host may have to end the run: its limit of memory is spent, or the system has no more.
enum class Memory { enough, spent, none };

/// A visit of a function that prepare() registered to the host. In between, run() does not return,
/// and allocation by Lua fails instead of abandoning the run; so objects with destructors may live.
class HostCall {
public:
    /// Does not return if time is up.
    static HostCall enter(lua_State* lua);
    /// Ends the visit and charges its work; does not return if a budget is spent.
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

/// The host of the interpreter, to be looked at only.
const void* host_of(lua_State* lua);

/// Line of the scene that is being executed; 0 if there is none.
int current_line(lua_State* lua);

}  // namespace deburr
