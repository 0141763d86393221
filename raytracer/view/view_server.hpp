// Serves the page of `deburr view` on 127.0.0.1.
//
// A client needs the token in the address and the right host name, or gets nothing, and a page of another site cannot
// read the answers. Nothing that a client sends is used as a file name.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "raytracer/view/live_picture.hpp"

namespace deburr {

/// The server for one LivePicture.
class ViewServer {
public:
    /// Returns the bytes of a file of the current scene; the extension is .exr or .png (from the film, which has this
    /// many samples) or .stl.
    using Encode =
        std::function<std::string(const std::string& extension, const Scene& scene, const Film* film, int samples)>;

    /// Starts the server at this port, or at a free one if it is 0; throws WorkError if that fails. Keeps a reference
    /// to the picture. `file` is the scene's name as the page shows it.
    ViewServer(LivePicture& picture, std::string file, Encode encode, int port);
    ~ViewServer();

    /// The page's address, http://127.0.0.1:PORT/TOKEN/.
    std::string address() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The page as one HTML text (view_page.html).
std::string_view view_page();

}  // namespace deburr
