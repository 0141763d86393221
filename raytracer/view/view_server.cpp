#include "raytracer/view/view_server.hpp"

#include <fmt/format.h>
#include <sys/random.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bounds/canonical_solids.hpp"
#include "raytracer/scene/scene_descriptions.hpp"
#include "raytracer/util/errors.hpp"
#include "raytracer/view/http_server.hpp"

namespace deburr {
namespace {

using Json = nlohmann::ordered_json;

// A request for the next frame is answered without one after this time, and then repeated by the page.
constexpr std::chrono::milliseconds longest_wait(5000);

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

// A solid's radii and line in the scene's file, for display.
struct SolidNotes {
    std::vector<double> radii;  // different filter radii of its leaves, at most as many as a page shows
    int line = 0;               // of the first leaf; 0: unknown
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

// Compressed for HTTP's "deflate" encoding (zlib's format), at the fastest level.
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
    std::unique_ptr<HttpServer> server = make_http_server();

    void add_routes() {
        const std::string root = "/" + token;
        const auto get = [&](const std::string& name, HttpHandler handler) {
            server->get(root + name, std::move(handler));
        };
        const auto post = [&](const std::string& name, auto take) {
            server->post(root + name,
                         [take](const HttpRequest& request, HttpResponse&) { take(Json::parse(request.body())); });
        };
        get("/", [](const HttpRequest&, HttpResponse& response) {
            response.body = view_page();
            response.type = "text/html; charset=utf-8";
        });
        get("/frame", [this](const HttpRequest& request, HttpResponse& response) { frame(request, response); });
        get("/scene", [this](const HttpRequest&, HttpResponse& response) { scene(response); });
        get("/pick", [this](const HttpRequest& request, HttpResponse& response) { pick(request, response); });
        for (const char* extension : {"exr", "png", "stl"})
            get(std::string("/picture.") + extension,
                [this, extension](const HttpRequest&, HttpResponse& response) { download(extension, response); });
        post("/camera", [this](const Json& j) {
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
        post("/parameters",
             [this](const Json& j) { picture.set_parameters(j.get<std::map<std::string, std::string>>()); });
        post("/wires", [this](const Json& j) { picture.show_wires(j.get<bool>()); });
    }

    // Answers with the length of a JSON header (4 bytes, little-endian), the header, and the pixels; compressed if the
    // page asks for it. Status 204 if there is nothing new.
    void frame(const HttpRequest& request, HttpResponse& response) {
        const auto frame = picture.wait_for_frame(std::atoi(request.parameter("after").c_str()), longest_wait);
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
        if (request.parameter("packed") == "1") {
            body = deflated(body);
            response.headers.emplace_back("Content-Encoding", "deflate");
        }
        response.body = std::move(body);
        response.type = "application/octet-stream";
    }

    void scene(HttpResponse& response) {
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
        response.body = dumped(j);
        response.type = "application/json";
    }

    void pick(const HttpRequest& request, HttpResponse& response) {
        const auto scene = picture.scene();
        const auto found =
            picture.pick(std::atof(request.parameter("x").c_str()), std::atof(request.parameter("y").c_str()));
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
        response.body = dumped(j);
        response.type = "application/json";
    }

    void download(const std::string& extension, HttpResponse& response) {
        int samples = 0;
        const auto film = picture.film(samples);
        const auto scene = picture.scene();
        if (!film || !scene) {
            response.status = 204;
            return;
        }
        response.headers.emplace_back("Content-Disposition", "attachment; filename=\"picture." + extension + "\"");
        response.body = encode("." + extension, *scene, film.get(), samples);
        response.type = "application/octet-stream";
    }
};

ViewServer::ViewServer(LivePicture& picture, std::string file, Encode encode, int port)
    : parts_(new Parts(picture, std::move(file), std::move(encode))) {
    Parts& p = *parts_;
    p.server->set_headers({{"Cache-Control", "no-store"},
                           {"Referrer-Policy", "no-referrer"},
                           {"X-Content-Type-Options", "nosniff"},
                           {"X-Frame-Options", "DENY"},
                           {"Cross-Origin-Resource-Policy", "same-origin"},
                           {"Content-Security-Policy",
                            "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src "
                            "'self'; img-src data:; base-uri 'none'; form-action 'none'"}});
    p.add_routes();
    p.port = p.server->start(port);
    if (p.port == 0) throw WorkError(fmt::format("cannot listen at 127.0.0.1:{}: the port is taken", port));
}

ViewServer::~ViewServer() { parts_->server->stop(); }

std::string ViewServer::address() const { return fmt::format("http://127.0.0.1:{}/{}/", parts_->port, parts_->token); }

}  // namespace deburr
