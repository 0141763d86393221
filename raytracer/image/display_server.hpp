// Shows a picture while it is rendered, in a viewer that listens on a port: tev, or another one with its protocol.
//
// The protocol is one TCP connection with packets of a 4-byte length (which includes itself), a type byte and the
// type's data; numbers are little-endian, texts end with a 0. An image is created once under a name (type 4), then its
// rows are replaced (type 6) by linear light in 32-bit floats. The viewer sends no answers.
#pragma once
#include <string>

#include "raytracer/image/film.hpp"

namespace deburr {

/// A connection to a viewer.
class DisplayServer {
public:
    /// Connects to "HOST:PORT", or "[ADDRESS]:PORT" for IPv6. Throws UsageError if `address` has another form,
    /// WorkError if the connection fails.
    explicit DisplayServer(const std::string& address);
    ~DisplayServer();
    DisplayServer(const DisplayServer&) = delete;
    DisplayServer& operator=(const DisplayServer&) = delete;

    /// Shows the film's window under this name, in place of what was shown under it. Throws WorkError if the viewer is
    /// gone or accepts no data for some seconds.
    void show(const std::string& name, const Film& film);

private:
    void send(std::string& packet);

    std::string address_, shown_;  // shown_: the name that was created last
    int socket_ = -1;
};

}  // namespace deburr
