// SPDX-License-Identifier: BSD-3-Clause
// Thread that takes the messages of isobar-dds from DDS and hands them to the server, undecoded.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/dds/participant.hpp"
#include "ipc/dds/raw_reader.hpp"
#include "tools/foxglove/protocol.hpp"
#include "tools/foxglove/server.hpp"

namespace isobar::tools::foxglove {

class TopicTap {
 public:
  /// @param ros_namespace of the robot; empty: none
  /// @throws ServiceError when a reader cannot be created
  TopicTap(const dds::Participant& participant, const std::string& ros_namespace);
  ~TopicTap() { stop(); }
  TopicTap(const TopicTap&) = delete;
  TopicTap& operator=(const TopicTap&) = delete;

  [[nodiscard]] std::vector<Channel> channels() const;
  /// Begins to take messages. `server` must outlive stop(). It is woken ten times a second, also without messages.
  void start(Server& server);
  void stop();

 private:
  void loop(Server& server) noexcept;

  std::vector<std::unique_ptr<dds::RawReader>> readers_;  ///< channel i + 1
  dds::Entity waitset_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace isobar::tools::foxglove
