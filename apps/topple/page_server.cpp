#include "page_server.h"

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <random>
#include <thread>

#include "text.h"

namespace topple::app {
namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr int kFirstPort = 8017;
constexpr int kPortsTried = 64;
/// A page that is busy with what has come takes nothing for a while, a long recording's for many seconds: it is not gone for that.
constexpr std::chrono::seconds kMostPatience{300};

/// What the page may do in the browser: its own scripts, workers and pictures that it made itself, and nothing from elsewhere.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; style-src 'self' 'unsafe-inline'; img-src 'self' "
    "blob: data:; "
    "font-src 'self'; connect-src 'self' blob:; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A page elsewhere that makes its own name point to this machine is told apart by the name it asks for.
bool asks_for_this_machine(const httplib::Request& request, int port) {
  if (request.get_header_value_count("Host") != 1) {
    return false;
  }
  const std::string host = request.get_header_value("Host");
  const std::string suffix = ":" + std::to_string(port);
  return host == kLoopback + suffix || host == "localhost" + suffix;
}

/// Browsers say from which page an order comes; this server's own pages alone may give any.
bool comes_from_here(const httplib::Request& request, int port) {
  if (!request.has_header("Origin")) return true;
  const std::string origin = request.get_header_value("Origin");
  const std::string suffix = ":" + std::to_string(port);
  return request.get_header_value_count("Origin") == 1 && (origin == "http://127.0.0.1" + suffix || origin == "http://localhost" + suffix);
}

void refuse(httplib::Response& response, int status, const char* words) {
  response.status = status;
  response.set_content(words, "text/plain; charset=utf-8");
}

/// Sent piece by piece from where it is, neither copied nor compressed: it goes nowhere but through this machine's memory.
void send(httplib::Response& response, const Content& content) {
  response.status = 200;
  response.set_header("Cache-Control", content.cache);
  if (content.bytes.empty()) {
    response.set_content("", content.type);
    return;
  }
  response.set_content_provider(content.bytes.size(), content.type,
                                [&content](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  sink.write(content.bytes.data() + offset, std::min(length, std::size_t{1} << 20));
                                  return true;
                                });
}

/// Only this program may listen on its port: the library's default would share it with a second one.
void set_own_port(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

}  // namespace

struct PageServer::State {
  Site site;
  int port = 0;
  httplib::Server server;
  std::string inbox;  // "/token/", or empty: nothing is taken.

  httplib::Server::HandlerResponse answer(const httplib::Request& request, httplib::Response& response) const {
    const auto found = site.find(request.path);
    if (!asks_for_this_machine(request, port)) {
      refuse(response, 403, "This server answers only to 127.0.0.1 and localhost.\n");
    } else if (request.method == "POST" && !inbox.empty() && request.path.starts_with(inbox)) {
      if (comes_from_here(request, port)) return httplib::Server::HandlerResponse::Unhandled;  // To receive() or stream().
      refuse(response, 403, "This server takes orders from its own page alone.\n");
    } else if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      refuse(response, 405, "This server only shows.\n");
    } else if (found == site.end()) {
      refuse(response, 404, "There is nothing here.\n");
    } else {
      send(response, found->second);
    }
    return httplib::Server::HandlerResponse::Handled;
  }
};

std::string make_token() {
  std::random_device device;
  return formatted("%08x%08x%08x%08x", device(), device(), device(), device());
}

PageServer::PageServer() : state_(std::make_unique<State>()) {}
PageServer::~PageServer() = default;
PageServer::PageServer(PageServer&&) noexcept = default;
PageServer& PageServer::operator=(PageServer&&) noexcept = default;

Result<PageServer> PageServer::listen(Site site, int port) {
  PageServer page;
  State& state = *page.state_;
  state.site = std::move(site);
  state.server.set_socket_options(set_own_port);
  state.server.set_write_timeout(kMostPatience);
  state.server.set_keep_alive_timeout(1);  // So that Ctrl-C does not wait long for a browser that holds its connection.
  state.server.set_payload_max_length(0);
  state.server.set_default_headers({{"Content-Security-Policy", kPolicy},
                                    {"X-Content-Type-Options", "nosniff"},
                                    {"Referrer-Policy", "no-referrer"},
                                    {"Cross-Origin-Opener-Policy", "same-origin"},
                                    {"Cross-Origin-Embedder-Policy", "require-corp"},
                                    {"Cross-Origin-Resource-Policy", "same-origin"}});
  state.server.set_pre_routing_handler(
      [&state](const httplib::Request& request, httplib::Response& response) { return state.answer(request, response); });
  const int first = port > 0 ? port : kFirstPort;
  const int last = port > 0 ? port : kFirstPort + kPortsTried - 1;
  for (state.port = first; state.port <= last; ++state.port) {
    if (state.server.bind_to_port(kLoopback, state.port)) {
      return page;
    }
  }
  return failure(
      port > 0 ? "Port " + std::to_string(port) +
                     " cannot be used: another program listens there, or it is not allowed. Without --port the next free one is taken."
               : "No port from " + std::to_string(first) + " to " + std::to_string(last) + " is free; choose one with --port.");
}

void PageServer::receive(const std::string& token, std::function<void(const std::string& what, std::string bytes)> take) {
  State& state = *state_;
  state.inbox = "/" + token + "/";
  state.server.set_payload_max_length(std::numeric_limits<std::size_t>::max());
  auto turn = std::make_shared<std::mutex>();
  state.server.Post(state.inbox + "(.+)", [take = std::move(take), turn](const httplib::Request& request, httplib::Response& response) {
    const std::lock_guard<std::mutex> one_at_a_time(*turn);
    take(request.matches[1], request.body);
    response.status = 204;
  });
}

void PageServer::stream(const std::string& token, std::size_t most,
                        std::function<std::expected<NextBytes, Refusal>(const std::string& body)> begin) {
  State& state = *state_;
  state.inbox = "/" + token + "/";
  state.server.set_payload_max_length(most);
  state.server.Post(state.inbox + "run", [begin = std::move(begin)](const httplib::Request& request, httplib::Response& response) {
    auto next = begin(request.body);
    if (!next) {
      refuse(response, next.error().status, next.error().words.c_str());
      return;
    }
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider("application/octet-stream", [next = std::move(*next)](std::size_t, httplib::DataSink& sink) {
      std::string bytes;
      if (!sink.is_writable()) return false;  // The page is gone.
      if (!next(bytes)) {
        sink.done();
        return true;
      }
      return bytes.empty() || sink.write(bytes.data(), bytes.size());
    });
  });
}

std::string PageServer::address() const { return std::string("http://") + kLoopback + ":" + std::to_string(state_->port) + "/"; }

bool PageServer::serve_until(bool (*done)()) {
  std::atomic<bool> served = true;
  std::atomic<bool> ended = false;
  // The first thread waits, not the one that accepts: it is the one that signals reach.
  std::thread listener([&] {
    served = state_->server.listen_after_bind();
    ended = true;
  });
  while (!ended) {
    if (done()) state_->server.stop();  // In vain while the listener has not begun: so again and again.
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  listener.join();
  return served || done();
}

}  // namespace topple::app
