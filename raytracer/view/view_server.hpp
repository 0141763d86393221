// The page of `deburr view`, on 127.0.0.1.
//
// Who does not know the token in the address, or asks by another host's name, gets nothing; a page of another site
// cannot read what is here. Nothing that the page sends is taken as the name of a file.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "raytracer/view/live_picture.hpp"

namespace deburr {

class ViewServer {
public:
    /// Bytes of a file of the scene as it is seen: .exr, .png (from the film, of so many samples), .stl.
    using Encode =
        std::function<std::string(const std::string& extension, const Scene& scene, const Film* film, int samples)>;

    /// Port 0: any that is free. Throws WorkError if it cannot be had. Keeps a reference to the picture.
    ViewServer(LivePicture& picture, std::string file, Encode encode, int port);
    ~ViewServer();

    /// http://127.0.0.1:PORT/TOKEN/
    std::string address() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The page, HTML in one piece (view_page.html).
std::string_view view_page();

}  // namespace deburr
