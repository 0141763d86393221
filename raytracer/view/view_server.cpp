#include "raytracer/view/view_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "bounds/canonical_solids.hpp"
#include "raytracer/scene/scene_descriptions.hpp"
#include "raytracer/util/errors.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

// Requests that wait for the next frame come back empty after so long, and are sent again.
constexpr std::chrono::milliseconds longest_wait(5000);
constexpr std::size_t largest_request = 1 << 16, threads = 16;

std::string random_token() {
    unsigned char bytes[16];
    if (getrandom(bytes, sizeof bytes, 0) != ssize_t(sizeof bytes)) throw WorkError("no random numbers are to be had");
    std::string token;
    for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
    return token;
}

Json vec_json(Vec3 v) { return {v.x, v.y, v.z}; }

Vec3 finite_vec(const Json& j) {
    const Vec3 v(j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>());
    if (!std::isfinite(v.x + v.y + v.z)) throw std::invalid_argument("expected finite numbers");
    return v;
}

Json camera_json(const Camera& c) {
    return {{"eye", vec_json(c.eye)}, {"target", vec_json(c.target)}, {"up", vec_json(c.up)}, {"fov", c.fov}};
}

// What the scene says of a solid.
struct SolidNotes {
    std::vector<double> radii;  // of its leaves, each once; no more than a page shows
    int line = 0;               // of the first leaf; 0: not known
};

SolidNotes notes_of(const Solid& solid) {
    constexpr std::size_t most = 8;
    SolidNotes notes;
    std::int64_t left = 10'000;
    for_each_leaf(
        {solid}, [&](const SolidNode&) { return left-- > 0; },
        [&](const Solid& leaf, const Affine&) {
            const SolidNode& node = leaf.node();
            if (notes.line == 0) notes.line = node.line;
            if (node.kind != SolidNode::Kind::rounded || notes.radii.size() >= most) return;
            if (std::find(notes.radii.begin(), notes.radii.end(), node.radius()) == notes.radii.end())
                notes.radii.push_back(node.radius());
        });
    return notes;
}

// As HTTP's "deflate" wants it (zlib's format), quickly.
std::string deflated(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), Z_BEST_SPEED) != Z_OK)
        throw WorkError("a frame could not be compressed");
    packed.resize(size);
    return packed;
}

std::string dumped(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

struct ViewServer::Parts {
    Parts(LivePicture& seen, std::string name, Encode how)
        : picture(seen), file(std::move(name)), encode(std::move(how)) {}

    LivePicture& picture;
    std::string file;
    Encode encode;
    std::string token = random_token();
    int port = 0;
    httplib::Server server;
    std::thread thread;

    void add_routes() {
        const std::string root = "/" + token;
        server.Get(root + "/", [](const httplib::Request&, httplib::Response& response) {
            const std::string_view page = view_page();
            response.set_content(page.data(), page.size(), "text/html; charset=utf-8");
        });
        server.Get(root + "/frame", [this](const auto& request, auto& response) { frame(request, response); });
        server.Get(root + "/scene", [this](const auto&, auto& response) { scene(response); });
        server.Get(root + "/pick", [this](const auto& request, auto& response) { pick(request, response); });
        for (const char* extension : {"exr", "png", "stl"})
            server.Get(root + "/picture." + extension,
                       [this, extension](const auto&, auto& response) { download(extension, response); });
        server.Post(root + "/camera", [this](const auto& request, auto&) {
            const Json j = Json::parse(request.body);
            if (j.is_null()) return picture.set_camera(std::nullopt);
            const auto now = picture.scene();
            Camera camera = now ? now->camera : Camera{};
            camera.eye = finite_vec(j.at("eye"));
            camera.target = finite_vec(j.at("target"));
            camera.up = finite_vec(j.at("up"));
            const Vec3 forward = camera.target - camera.eye;
            if (!(glm::length(glm::cross(forward, camera.up)) > 1e-9 * glm::length(forward) * glm::length(camera.up)))
                throw std::invalid_argument("expected a camera that looks somewhere, not along up");
            picture.set_camera(camera);
        });
        server.Post(root + "/parameters", [this](const auto& request, auto&) {
            picture.set_parameters(Json::parse(request.body).template get<std::map<std::string, std::string>>());
        });
        server.Post(root + "/wires", [this](const auto& request, auto&) {
            picture.show_wires(Json::parse(request.body).template get<bool>());
        });
    }

    // The length of a JSON head (4 bytes, little-endian), the head, and the pixels, compressed where the page asks for
    // that; 204 if there is nothing new.
    void frame(const httplib::Request& request, httplib::Response& response) {
        const auto frame = picture.wait_for_frame(std::atoi(request.get_param_value("after").c_str()), longest_wait);
        if (!frame) {
            response.status = 204;
            return;
        }
        const std::string head = dumped({{"number", frame->number},
                                         {"width", frame->width},
                                         {"height", frame->height},
                                         {"samples", frame->samples},
                                         {"all_samples", frame->all_samples},
                                         {"finished", frame->is_finished},
                                         {"error", frame->error},
                                         {"scene", frame->scene}});
        std::string body;
        body.reserve(4 + head.size() + frame->rgba.size());
        for (int i = 0; i < 4; ++i) body.push_back(char(head.size() >> 8 * i & 255));
        body += head;
        body += frame->rgba;
        if (request.get_param_value("packed") == "1") {
            body = deflated(body);
            response.set_header("Content-Encoding", "deflate");
        }
        response.set_content(std::move(body), "application/octet-stream");
    }

    void scene(httplib::Response& response) {
        const auto scene = picture.scene();
        if (!scene) {
            response.status = 204;
            return;
        }
        const Json j = {{"file", file},
                        {"width", scene->width},
                        {"height", scene->height},
                        {"solids", scene->solids.size()},
                        {"up", vec_json(scene->z_up ? Vec3(0, 0, 1) : Vec3(0, 1, 0))},
                        {"camera", camera_json(scene->camera)},
                        {"parameters", scene->parameters}};
        response.set_content(dumped(j), "application/json");
    }

    void pick(const httplib::Request& request, httplib::Response& response) {
        const auto scene = picture.scene();
        const auto found = picture.pick(std::atof(request.get_param_value("x").c_str()),
                                        std::atof(request.get_param_value("y").c_str()));
        Json j;
        if (scene && found && found->solid >= 0 && std::size_t(found->solid) < scene->solids.size()) {
            const std::size_t i = std::size_t(found->solid);
            const SolidNotes notes = notes_of(scene->solids[i]);
            const std::string name = i < scene->names.size() ? scene->names[i] : "";
            j = {{"solid", name.empty() ? fmt::format("solid {}", i + 1) : name},
                 {"place", scene->place(notes.line)},
                 {"material", found->material < int(scene->materials.size())
                                  ? name_of(scene->materials[std::size_t(found->material)].kind)
                                  : ""},
                 {"radii", notes.radii},
                 {"position", vec_json(found->position)},
                 {"normal", vec_json(found->normal)}};
        }
        response.set_content(dumped(j), "application/json");
    }

    void download(const std::string& extension, httplib::Response& response) {
        int samples = 0;
        const auto film = picture.film(samples);
        const auto scene = picture.scene();
        if (!film || !scene) {
            response.status = 204;
            return;
        }
        response.set_header("Content-Disposition", "attachment; filename=\"picture." + extension + "\"");
        response.set_content(encode("." + extension, *scene, film.get(), samples), "application/octet-stream");
    }
};

ViewServer::ViewServer(LivePicture& picture, std::string file, Encode encode, int port)
    : parts_(new Parts(picture, std::move(file), std::move(encode))) {
    Parts& p = *parts_;
    httplib::Server& server = p.server;
    server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    server.set_payload_max_length(largest_request);
    server.set_keep_alive_timeout(10);
    // The library's own options let two programs share a port.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_default_headers(
        {{"Cache-Control", "no-store"},
         {"Referrer-Policy", "no-referrer"},
         {"X-Content-Type-Options", "nosniff"},
         {"X-Frame-Options", "DENY"},
         {"Cross-Origin-Resource-Policy", "same-origin"},
         {"Content-Security-Policy",
          "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src "
          "'self'; img-src data:; base-uri 'none'; form-action 'none'"}});
    server.set_pre_routing_handler([&p](const httplib::Request& request, httplib::Response& response) {
        const std::string host = request.get_header_value("Host");
        if (host == fmt::format("127.0.0.1:{}", p.port) || host == fmt::format("localhost:{}", p.port))
            return httplib::Server::HandlerResponse::Unhandled;
        response.status = 403;
        return httplib::Server::HandlerResponse::Handled;
    });
    server.set_exception_handler([](const httplib::Request&, httplib::Response& response, const auto&... error) {
        response.status = 400;
        try {
            if constexpr (requires { std::rethrow_exception(error...); })
                std::rethrow_exception(error...);
            else
                response.set_content((std::string(error.what()) + ...), "text/plain");
        } catch (const std::exception& e) {
            response.set_content(e.what(), "text/plain");
        }
    });
    p.add_routes();
    if (port == 0)
        p.port = server.bind_to_any_port("127.0.0.1");
    else
        p.port = server.bind_to_port("127.0.0.1", port) ? port : -1;
    if (p.port <= 0) throw WorkError(fmt::format("cannot listen at 127.0.0.1:{}: the port is taken", port));
    p.thread = std::thread([&server] { server.listen_after_bind(); });
    while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

ViewServer::~ViewServer() {
    parts_->server.stop();
    parts_->thread.join();
}

std::string ViewServer::address() const { return fmt::format("http://127.0.0.1:{}/{}/", parts_->port, parts_->token); }

}  // namespace deburr
