// A small HTTP server on 127.0.0.1. It is a module (cpp-httplib): linked, it cost every call of the program 1.7 ms,
// most of them to load libraries for encryption that nothing here needs.
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
    /// The value of `?name=value`; "" if there is none.
    virtual std::string parameter(const std::string& name) const = 0;
    virtual const std::string& body() const = 0;
};

/// The answer to a request.
struct HttpResponse {
    int status = 200;
    std::string body, type;  // MIME
    std::vector<std::pair<std::string, std::string>> headers;
};

using HttpHandler = std::function<void(const HttpRequest& request, HttpResponse& response)>;

/// Answers on several threads at once. A handler that throws a std::exception is answered by status 400 with its words;
/// a client that names another host than 127.0.0.1 or localhost by 403.
class HttpServer {
public:
    virtual ~HttpServer() = default;
    virtual void get(const std::string& path, HttpHandler handler) = 0;
    virtual void post(const std::string& path, HttpHandler handler) = 0;
    /// Headers of every answer.
    virtual void set_headers(std::vector<std::pair<std::string, std::string>> headers) = 0;
    /// Takes a port, 0: any that is free, and answers from then on. Returns its number; 0 if it cannot be had.
    virtual int start(int port) = 0;
    /// Ends all answers; start() must have been called before.
    virtual void stop() = 0;
};

/// Throws UnsupportedError if the module cannot be loaded.
std::unique_ptr<HttpServer> make_http_server();

/// Type and name of the function that the module exports.
using HttpModuleEntry = HttpServer*();
constexpr const char* http_module_entry = "deburr_http_module";

}  // namespace deburr
