// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time/clock_anchor.hpp"
#include "core/time/system_clock_watch.hpp"
#include "daemon/bridge/settings.hpp"
#include "daemon/bridge/writer_choice.hpp"
#include "drivers/cloud/cloud_decoder.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// Clouds of a ROS 2 lidar driver, converted to scans for isobard: lidar.source = "dds". One thread, but counts().
class CloudInput {
 public:
  /// @throws ServiceError when the reader cannot be created
  CloudInput(dds_entity_t participant, const Settings& settings);

  /// Takes the waiting clouds and publishes their scans, stamped on isobard's clock.
  /// @param now_ns isobard's clock
  void take(std::int64_t now_ns, const SystemClockWatch& system_clock);
  /// Takes the waiting clouds and drops them: isobard's clock is not known yet.
  void drop();

  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_.get(); }
  /// Clouds that break a rule, or for which shared memory had no chunk. Any thread.
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Clouds of a second lidar. Any thread.
  [[nodiscard]] std::uint64_t other_senders() const noexcept {
    return other_senders_.load(std::memory_order_relaxed);
  }

 private:
  void convert(const dds::CloudMessage& message, std::int64_t now_ns, const SystemClockWatch& system_clock);
  void refuse(const char* rule);

  dds::Reader<dds::CloudMessage> reader_;
  ipc::Publisher<Scan> publisher_;
  CloudDecoder decoder_;
  std::vector<CloudField> fields_;
  ClockAnchor anchor_;
  SenderClock sender_clock_;
  bool anchored_ = false;
  WriterChoice writer_;
  CloudFormat said_;
  bool has_said_ = false;
  std::string said_rule_;
  std::atomic<std::uint64_t> refused_{0};
  std::atomic<std::uint64_t> other_senders_{0};
};

}  // namespace isobar::bridge
