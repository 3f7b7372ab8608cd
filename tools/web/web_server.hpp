// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "tools/web/action_desk.hpp"
#include "tools/web/host_check.hpp"
#include "tools/web/live_state.hpp"
#include "tools/web/map_tiles.hpp"
#include "tools/web/token.hpp"

namespace isobar::web {

/// Where to listen.
struct WebAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;     ///< 0: a free one
  std::size_t most_viewers = 8;  ///< open pages with live events
};

/// What is served. Must outlive the server.
struct Served {
  std::function<std::string()> view;  ///< /api/view; any thread
  const MapTiles* map = nullptr;
  LiveState* live = nullptr;      ///< null: a run or a recording
  ActionDesk* actions = nullptr;  ///< null: read-only
  const Token* token = nullptr;   ///< of the actions
  HostCheck hosts{{}};
};

/// HTTP server of the page, in threads of its own. Serves its own files and /api only.
class WebServer {
 public:
  /// Listens.
  /// @throws ServiceError when the address cannot be listened on
  WebServer(const WebAddress& address, Served served);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Port that is listened on.
  [[nodiscard]] std::uint16_t port() const;
  /// Pages that get live events now.
  [[nodiscard]] std::size_t viewers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isobar::web
