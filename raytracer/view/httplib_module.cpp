// The module behind raytracer/view/http_server.hpp, by cpp-httplib.
#include <httplib.h>

#include <chrono>
#include <thread>

#include "raytracer/view/http_server.hpp"

namespace deburr {
namespace {

constexpr std::size_t largest_request = 1 << 16, threads = 16;  // bytes

class Request final : public HttpRequest {
public:
    explicit Request(const httplib::Request& request) : request_(request) {}
    std::string parameter(const std::string& name) const override { return request_.get_param_value(name.c_str()); }
    const std::string& body() const override { return request_.body; }

private:
    const httplib::Request& request_;
};

httplib::Server::Handler with(HttpHandler handler) {
    return [handler = std::move(handler)](const httplib::Request& request, httplib::Response& response) {
        HttpResponse answer;
        handler(Request(request), answer);
        response.status = answer.status;
        for (const auto& [name, value] : answer.headers) response.set_header(name.c_str(), value);
        if (!answer.type.empty()) response.set_content(std::move(answer.body), answer.type.c_str());
    };
}

class Server final : public HttpServer {
public:
    Server() {
        server_.new_task_queue = [] { return new httplib::ThreadPool(threads); };
        server_.set_payload_max_length(largest_request);
        server_.set_keep_alive_timeout(10);
        // The library's own options would let two programs share a port.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            const std::string host = request.get_header_value("Host"), port = ":" + std::to_string(port_);
            if (host == "127.0.0.1" + port || host == "localhost" + port)
                return httplib::Server::HandlerResponse::Unhandled;
            response.status = 403;
            return httplib::Server::HandlerResponse::Handled;
        });
        server_.set_exception_handler([](const httplib::Request&, httplib::Response& response, const auto&... error) {
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
    }

    void get(const std::string& path, HttpHandler handler) override { server_.Get(path, with(std::move(handler))); }
    void post(const std::string& path, HttpHandler handler) override { server_.Post(path, with(std::move(handler))); }
    void set_headers(std::vector<std::pair<std::string, std::string>> headers) override {
        httplib::Headers all;
        for (auto& header : headers) all.insert(std::move(header));
        server_.set_default_headers(std::move(all));
    }
    int start(int port) override {
        if (port == 0)
            port_ = std::max(server_.bind_to_any_port("127.0.0.1"), 0);
        else
            port_ = server_.bind_to_port("127.0.0.1", port) ? port : 0;
        if (port_ == 0) return 0;
        thread_ = std::thread([this] { server_.listen_after_bind(); });
        while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return port_;
    }
    void stop() override {
        server_.stop();
        thread_.join();
    }

private:
    httplib::Server server_;
    std::thread thread_;
    int port_ = 0;
};

}  // namespace
}  // namespace deburr

extern "C" __attribute__((visibility("default"))) deburr::HttpServer* deburr_http_module() {
    return new deburr::Server;
}
