#include "raytracer/view/http_server.hpp"

#include "raytracer/util/module.hpp"

namespace deburr {

std::unique_ptr<HttpServer> make_http_server() {
    return std::unique_ptr<HttpServer>(
        module_function<HttpModuleEntry>(DEBURR_HTTP_MODULE, http_module_entry, "pages")());
}

}  // namespace deburr
