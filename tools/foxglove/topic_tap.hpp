// SPDX-License-Identifier: BSD-3-Clause
// Thread that takes the messages of isobar-dds from DDS and hands them on, undecoded.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/dds/participant.hpp"
#include "ipc/dds/raw_reader.hpp"
#include "tools/foxglove/client_queue.hpp"
#include "tools/foxglove/protocol.hpp"

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
  /// Begins to take messages. The thread calls `take` with each, and `turn` at least ten times a second; neither may
  /// throw, and both must live until stop().
  using Take = std::function<void(std::uint32_t channel, std::shared_ptr<const Data> data)>;
  void start(Take take, std::function<void()> turn);
  void stop();

 private:
  void loop(const Take& take, const std::function<void()>& turn) noexcept;

  std::vector<std::unique_ptr<dds::RawReader>> readers_;  ///< channel i + 1
  dds::Entity waitset_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace isobar::tools::foxglove
