// A small HTTP server on 127.0.0.1. It is a module (cpp-httplib): linking it would add 1.7 ms to every run, most of it
// to load encryption libraries that are not needed here.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace deburr {

/// A client's request.
class HttpRequest {
public:
    virtual ~HttpRequest() = default;
    /// The value of `name` in the address's query `?name=value`; "" if there is none.
    virtual std::string parameter(const std::string& name) const = 0;
    virtual const std::string& body() const = 0;
};

/// The answer to a request.
struct HttpResponse {
    int status = 200;
    std::string body, type;  // type: MIME type
    std::vector<std::pair<std::string, std::string>> headers;
};

using HttpHandler = std::function<void(const HttpRequest& request, HttpResponse& response)>;

/// A server that answers on several threads. If a handler throws a std::exception, the answer is status 400 with its
/// message; a request for a host other than 127.0.0.1 or localhost is answered by 403.
class HttpServer {
public:
    virtual ~HttpServer() = default;
    /// Sets the handler for a method and path.
    virtual void get(const std::string& path, HttpHandler handler) = 0;
    virtual void post(const std::string& path, HttpHandler handler) = 0;
    /// Sets headers that every answer gets.
    virtual void set_headers(std::vector<std::pair<std::string, std::string>> headers) = 0;
    /// Starts answering at this port, or at a free one if it is 0. Returns the port; 0 if it is not available.
    virtual int start(int port) = 0;
    /// Stops the server, which must have been started.
    virtual void stop() = 0;
};

/// Makes a server. Throws UnsupportedError if the module cannot be loaded.
std::unique_ptr<HttpServer> make_http_server();

/// Type and name of the function that the module exports; the caller owns the result.
using HttpModuleEntry = HttpServer*();
constexpr const char* http_module_entry = "deburr_http_module";

}  // namespace deburr
