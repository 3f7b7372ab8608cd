// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "tools/web/page_files.hpp"
#include "tools/web/web_server.hpp"

namespace isobar::test::test_web_server {

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

const std::string kToken = "0123456789abcdef";

/// A live server with room for two viewers.
struct LiveServer {
  web::LiveState live;
  web::MapTiles map{1};
  web::ActionDesk desk;
  web::Token token{kToken, "token"};
  std::unique_ptr<web::WebServer> server;

  explicit LiveServer(bool with_actions = true) {
    web::Served served;
    served.view = [] { return std::string(R"({"schema":1})"); };
    served.map = &map;
    served.live = &live;
    served.actions = with_actions ? &desk : nullptr;
    served.token = with_actions ? &token : nullptr;
    web::WebAddress address;
    address.port = 0;
    address.most_viewers = 2;
    server = std::make_unique<web::WebServer>(address, std::move(served));
  }
  [[nodiscard]] httplib::Client client() const {
    httplib::Client client("127.0.0.1", server->port());
    client.set_read_timeout(5);
    return client;
  }
};

/// A viewer that asks for the live events and never reads.
class DeafViewer {
 public:
  explicit DeafViewer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const int small = 4096;
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    const std::string request = "GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n";
    REQUIRE(::send(socket_, request.data(), request.size(), 0) == static_cast<ssize_t>(request.size()));
  }
  ~DeafViewer() { ::close(socket_); }
  DeafViewer(const DeafViewer&) = delete;
  DeafViewer& operator=(const DeafViewer&) = delete;

 private:
  int socket_;
};

template <class Condition>
bool comes_true(const Condition& condition, std::chrono::milliseconds within) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

}  // namespace

TEST_CASE("every answer forbids what comes from elsewhere, and the page is served where there is one") {
  const LiveServer fixture;
  auto client = fixture.client();
  for (const char* path : {"/", "/page.js", "/api/view", "/api/map", "/nothing", "/../etc/passwd"}) {
    const auto answer = client.Get(path);
    REQUIRE(answer);
    CHECK(answer->get_header_value("Content-Security-Policy").find("default-src 'none'") == 0);
    CHECK(answer->get_header_value("X-Content-Type-Options") == "nosniff");
  }
  CHECK(client.Get("/")->status == (web::page_files().empty() ? 404 : 200));
  CHECK(client.Get("/nothing")->status == 404);
  CHECK(client.Get("/../etc/passwd")->status == 404);
  CHECK(client.Get("/api/view")->body == R"({"schema":1})");
}

TEST_CASE("a request for another host, from another page, of another method or for ranges is refused") {
  const LiveServer fixture;
  auto client = fixture.client();
  CHECK(client.Get("/api/view", {{"Host", "evil.example"}})->status == 421);
  CHECK(client.Get("/api/view", {{"Host", "localhost"}, {"Origin", "http://evil.example"}})->status == 403);
  CHECK(client.Get("/api/view", {{"Host", "localhost"}, {"Origin", "http://localhost"}})->status == 200);
  CHECK(client.Delete("/api/view")->status == 405);
  CHECK(client.Get("/api/map", {{"Range", "bytes=0-,0-,0-,0-"}})->status == 416);
}

TEST_CASE("an action needs the token, and a server without one has no actions") {
  LiveServer fixture;
  auto client = fixture.client();
  const std::string body = R"({"x_m":1,"y_m":2,"yaw_deg":90})";
  const httplib::Headers wrong{{"Authorization", "Bearer 0123456789abcdeX"}};
  const httplib::Headers right{{"Authorization", "Bearer " + kToken}};
  CHECK(client.Post("/api/save-black-box")->status == 401);
  CHECK(client.Post("/api/initial-pose", wrong, body, "application/json")->status == 401);
  CHECK(!fixture.desk.take());
  CHECK(client.Post("/api/initial-pose", right, R"({"x_m":1})", "application/json")->status == 400);
  CHECK(client.Post("/api/initial-pose", right, R"({"x_m":1e300,"y_m":2,"yaw_deg":90})", "application/json")
            ->status == 400);
  CHECK(client.Post("/api/initial-pose", right, std::string(5000, ' '), "application/json")->status == 413);
  CHECK(!fixture.desk.take());
  CHECK(client.Post("/api/initial-pose", right, body, "application/json")->status == 202);
  CHECK(client.Post("/api/initial-pose", right, body, "application/json")->status == 503);
  const auto order = fixture.desk.take();
  REQUIRE(order);
  CHECK(order->hint.x_m == 1.0);
  CHECK(order->hint.yaw_rad == doctest::Approx(1.5708));
  const LiveServer read_only(false);
  CHECK(read_only.client().Post("/api/save-black-box", right, "", "text/plain")->status == 403);
}

TEST_CASE("a viewer gets live events until it goes, and beyond the limit a viewer is refused") {
  LiveServer fixture;
  std::atomic<int> received{0};
  std::atomic<bool> go_on{true};
  std::vector<std::thread> viewers;
  for (int i = 0; i < 2; ++i) {
    viewers.emplace_back([&] {
      auto client = fixture.client();
      static_cast<void>(client.Get("/api/events", [&](const char* data, std::size_t length) {
        if (std::string_view(data, length).find("event: pose") != std::string_view::npos) ++received;
        return go_on.load();
      }));
    });
  }
  CHECK(comes_true([&] { return fixture.server->viewers() == 2; }, 2s));
  fixture.live.add_pose({}, "{}");
  CHECK(comes_true([&] { return received == 2; }, 2s));
  CHECK(fixture.client().Get("/api/events")->status == 503);
  CHECK(fixture.client().Get("/api/view")->status == 200);
  go_on = false;
  fixture.live.add_pose({}, "{}");
  for (std::thread& viewer : viewers) viewer.join();
  // The server notices with the next things that it sends.
  CHECK(comes_true(
      [&] {
        fixture.live.add_pose({}, "{}");
        return fixture.server->viewers() == 0;
      },
      3s));
}

TEST_CASE("viewers that stop reading hold up nobody, and the end does not wait for them") {
  LiveServer fixture;
  const DeafViewer first(fixture.server->port());
  const DeafViewer second(fixture.server->port());
  CHECK(comes_true([&] { return fixture.server->viewers() == 2; }, 2s));
  const std::string large(20'000, ' ');
  for (int i = 0; i < 200; ++i) fixture.live.put(web::Topic::kStatus, "\"" + large + "\"");
  const auto answer = fixture.client().Get("/api/view");
  REQUIRE(answer);
  CHECK(answer->status == 200);
}

TEST_CASE("an address that cannot be listened on is said") {
  const LiveServer fixture;
  web::WebAddress taken;
  taken.port = fixture.server->port();
  web::Served served;
  served.view = [] { return std::string(); };
  served.map = &fixture.map;
  CHECK_THROWS_AS(web::WebServer(taken, std::move(served)), ServiceError);
}

}  // namespace isobar::test::test_web_server
