// SPDX-License-Identifier: BSD-3-Clause
// The bridge's connection to isobard.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "daemon/bridge/forwarding.hpp"
#include "daemon/bridge/network.hpp"
#include "daemon/bridge/outputs.hpp"
#include "daemon/bridge/receiving.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/service.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Name in shared memory and in the log.
inline constexpr const char* kProgram = "isobar-dds";

/// The shared-memory side and both directions of forwarding, from attaching to isobard until the end.
class Connection {
 public:
  /// @throws ServiceError when shared memory or a DDS reader is refused
  Connection(std::unique_ptr<ipc::Attachment> attachment, Network& network, Outputs& outputs,
             const Settings& settings);

  /// What isobard says about itself, after each change.
  [[nodiscard]] ipc::Received<ipc::RunDescription> description() noexcept {
    return descriptions_.take_latest();
  }

  /// One round of the supervise loop. Restarts the process when the connection has become useless.
  /// @return true when the pose thread has completed a round since the last call
  bool check();

  /// Makes the DDS side anew. Messages of isobard wait meanwhile and are then forwarded: none is lost.
  void renew_network();
  /// The same with other settings.
  /// @param change changes the settings to `next`
  void change_settings(const Settings& next, const std::function<void()>& change);

 private:
  void receive();
  void announce();
  [[noreturn]] void restart();
  [[nodiscard]] std::optional<std::string> reason_to_restart() const;

  std::unique_ptr<ipc::Attachment> attachment_;
  Network& network_;
  const Settings& settings_;
  Forwarding forwarding_;
  ipc::Subscriber<ipc::RunDescription> descriptions_{ipc::topics::kRunDescription};
  std::optional<Receiving> receiving_;  ///< while there is a network
  std::uint64_t rounds_ = 0;
  std::size_t announced_floor_writers_ = 0;
};

/// Attaches to isobard, and publishes its absence in the diagnostics until it runs.
class Connector {
 public:
  /// @param attachment of an earlier attempt, if any
  Connector(Outputs& outputs, const std::string& node_name, std::unique_ptr<ipc::Attachment> attachment)
      : outputs_(outputs), early_(std::move(attachment)) {
    set_node_name(node_name);
  }

  void set_node_name(const std::string& node_name) { builder_.emplace(node_name); }

  /// Waits 0.4 s for isobard. Logs what it waits for, at once and then every minute.
  /// @return null while isobard does not run
  std::unique_ptr<ipc::Attachment> attach(Service& service);

 private:
  Outputs& outputs_;
  std::unique_ptr<ipc::Attachment> early_;
  std::optional<dds::DiagnosticsBuilder> builder_;  ///< never empty
  std::int64_t next_line_ns_ = 0;
};

}  // namespace isobar::bridge
