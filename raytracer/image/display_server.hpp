// A picture on its way, shown by a viewer that listens: tev, or another that knows its protocol.
//
// One TCP connection; packets are a length of 4 bytes, which counts itself, a type of one byte and what belongs to it,
// all numbers little-endian, texts ended by a 0. An image is created once under a name (type 4) and then its rows are
// replaced (type 6), as linear light in 32-bit numbers. Nothing is ever answered.
#pragma once
#include <string>

#include "raytracer/image/film.hpp"

namespace deburr {

class DisplayServer {
public:
    /// Connects to "HOST:PORT", or "[ADDRESS]:PORT" of IPv6. Throws UsageError where it is no such, WorkError where
    /// nobody listens there.
    explicit DisplayServer(const std::string& address);
    ~DisplayServer();
    DisplayServer(const DisplayServer&) = delete;
    DisplayServer& operator=(const DisplayServer&) = delete;

    /// Shows the film's window under this name, in place of what was shown under it. Throws WorkError where the viewer
    /// is gone, or takes nothing for seconds.
    void show(const std::string& name, const Film& film);

private:
    void send(std::string& packet);

    std::string address_, shown_;  // the name that was created last
    int socket_ = -1;
};

}  // namespace deburr
