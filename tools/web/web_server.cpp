// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/web_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <utility>

#include "core/errors.hpp"
#include "tools/web/bounded_tasks.hpp"
#include "tools/web/page_files.hpp"

namespace isobar::web {
namespace {

using httplib::Request;
using httplib::Response;

constexpr const char* kJson = "application/json; charset=utf-8";
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr std::size_t kMostBodyBytes = 4096;
/// For requests beside the live events.
constexpr std::size_t kMoreThreads = 8;
/// A viewer that takes nothing for this long is dropped [s].
constexpr int kWriteTimeoutS = 5;
constexpr int kReadTimeoutS = 5;
/// Bytes that the kernel holds for a viewer.
constexpr int kSendBufferBytes = 128 * 1024;
/// Something is sent at least so often, so that a viewer knows that the link lives.
constexpr std::chrono::milliseconds kHeartbeat{1000};

/// Nothing from elsewhere is loaded, run, framed or sent to.
const httplib::Headers kHeaders{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"}};

void answer(Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text + "\n", kText);
}

std::uint32_t number_of(const Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  std::uint32_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// A body that is sent as it is: httplib would compress it anew for each request.
void set_plain(Response& response, std::string body, const char* type) {
  const auto shared = std::make_shared<const std::string>(std::move(body));
  response.set_content_provider(shared->size(), type,
                                [shared](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(shared->data() + offset, length);
                                });
}

/// One of a bounded number of viewers, as long as it lives.
class Seat {
 public:
  /// @return null when all are taken
  static std::shared_ptr<Seat> take(std::atomic<std::size_t>& taken, std::size_t most) {
    if (taken.fetch_add(1) < most) return std::make_shared<Seat>(taken);
    --taken;
    return nullptr;
  }
  explicit Seat(std::atomic<std::size_t>& taken) : taken_(taken) {}
  ~Seat() { --taken_; }
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;

 private:
  std::atomic<std::size_t>& taken_;
};

}  // namespace

struct WebServer::Impl {
  WebAddress address;
  Served served;
  std::atomic<std::size_t> viewers{0};
  httplib::Server server;
  std::thread thread;

  Impl(const WebAddress& where, Served what) : address(where), served(std::move(what)) {
    set_limits();
    server.set_pre_routing_handler(
        [this](const Request& request, Response& response) { return check(request, response); });
    server.set_exception_handler([](const Request&, Response& response, const std::exception_ptr&) {
      answer(response, 500, "this failed; the log of isobar web may say why");
    });
    add_page();
    server.Get("/api/view",
               [this](const Request&, Response& response) { set_plain(response, served.view(), kJson); });
    server.Get("/api/map", [this](const Request& request, Response& response) {
      set_plain(response, served.map->changes_since(number_of(request, "epoch"), number_of(request, "since")),
                "application/octet-stream");
    });
    if (served.live != nullptr) add_live();
    listen();
    thread = std::thread([this] { server.listen_after_bind(); });
    // httplib's stop() does nothing before the server runs.
    while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  /// @throws ServiceError when the address cannot be listened on
  void listen() {
    const int port = address.port == 0 ? server.bind_to_any_port(address.address)
                     : server.bind_to_port(address.address, address.port) ? address.port
                                                                          : -1;
    if (port < 0) {
      throw ServiceError(
          address.address + ":" + std::to_string(address.port) +
          ": cannot be listened on; the address does not exist or another program uses the port");
    }
    address.port = static_cast<std::uint16_t>(port);
  }

  void set_limits() {
    const std::size_t threads = (served.live == nullptr ? 0 : address.most_viewers) + kMoreThreads;
    server.new_task_queue = [threads] { return new BoundedTasks(threads); };  // the server deletes it
    server.set_payload_max_length(kMostBodyBytes);
    server.set_keep_alive_max_count(1);  // an idle connection would hold a thread
    server.set_read_timeout(kReadTimeoutS);
    server.set_write_timeout(kWriteTimeoutS);
    server.set_tcp_nodelay(true);
    server.set_default_headers(kHeaders);
    // Without SO_REUSEPORT, by which another program could take half of the connections.
    server.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes);
    });
  }

  /// Before every request.
  httplib::Server::HandlerResponse check(const Request& request, Response& response) const {
    using Result = httplib::Server::HandlerResponse;
    const std::string host = request.get_header_value("Host");
    const std::string origin = request.get_header_value("Origin");
    if (!served.hosts.allows(host)) {
      answer(response, 421, "this machine is not the host that the request names; see isobar web --host");
    } else if (request.method != "GET" && request.method != "HEAD" && request.method != "POST") {
      answer(response, 405, "only GET, HEAD and POST are served");
    } else if (!origin.empty() && !is_same_origin(origin, host)) {
      answer(response, 403, "the request comes from another page");
    } else if (request.has_header("Range")) {
      response.status = 416;  // a thousand ranges of a map would fill the memory
    } else {
      return Result::Unhandled;
    }
    return Result::Handled;
  }

  void add_page() {
    for (const PageFile& file : page_files()) {
      server.Get(std::string(file.path), [file](const Request&, Response& response) {
        response.set_header("Content-Encoding", "gzip");
        response.set_content_provider(
            file.gzip.size(), file.type.data(),
            [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
              return sink.write(file.gzip.data() + offset, length);
            });
      });
    }
    if (page_files().empty()) {
      server.Get("/", [](const Request&, Response& response) { answer(response, 404, kPageMissing); });
    }
  }

  void add_live() {
    server.Get("/api/events", [this](const Request&, Response& response) {
      const auto seat = Seat::take(viewers, address.most_viewers);
      if (!seat) {
        answer(response, 503,
               "too many viewers: " + std::to_string(address.most_viewers) +
                   " have this page open (isobar web --viewers)");
        return;
      }
      const auto cursor = std::make_shared<Cursor>();
      response.set_chunked_content_provider(
          "text/event-stream", [this, seat, cursor](std::size_t, httplib::DataSink& sink) {
            std::string events;
            if (!served.live->wait_for_news(*cursor, kHeartbeat, events))
              events = "event: alive\ndata: {}\n\n";
            return !served.live->stopped() && sink.write(events.data(), events.size());
          });
    });
    add_actions();
  }

  void add_actions() {
    server.Post("/api/save-black-box", [this](const Request& request, Response& response) {
      if (may_act(request, response)) offer({}, "The black box is being saved.", response);
    });
    server.Post("/api/initial-pose", [this](const Request& request, Response& response) {
      if (!may_act(request, response)) return;
      std::string reason;
      const auto hint = parse_hint(request.body, reason);
      if (!hint) return answer(response, 400, reason);
      offer({Order::Kind::kPoseHint, *hint}, "The hint is being tried.", response);
    });
  }

  bool may_act(const Request& request, Response& response) const {
    if (served.actions == nullptr || served.token == nullptr) {
      answer(response, 403, "this page is read-only: isobar web was started without --token-file");
      return false;
    }
    if (!served.token->matches(request.get_header_value("Authorization"))) {
      answer(response, 401, "the token is missing or wrong");
      return false;
    }
    return true;
  }

  void offer(const Order& order, const std::string& done, Response& response) const {
    if (served.actions->offer(order)) return answer(response, 202, done);
    answer(response, 503, "another action waits; try again");
  }
};

WebServer::WebServer(const WebAddress& address, Served served)
    : impl_(std::make_unique<Impl>(address, std::move(served))) {}

WebServer::~WebServer() {
  if (impl_->served.live != nullptr) impl_->served.live->stop();
  impl_->server.stop();
  impl_->thread.join();
}

std::uint16_t WebServer::port() const { return impl_->address.port; }

std::size_t WebServer::viewers() const { return impl_->viewers; }

}  // namespace isobar::web
