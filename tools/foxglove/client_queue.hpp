// SPDX-License-Identifier: BSD-3-Clause
// Messages that wait for one client, bounded: a client that stops reading loses messages, not the server memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace isobar::tools::foxglove {

/// A message of a topic, shared by all clients that want it.
struct Data {
  std::int64_t stamp_ns = 0;  ///< time of reception, system clock
  std::vector<std::uint8_t> cdr;
};

/// One thing to send: a text, or data for a subscription.
struct Outgoing {
  std::string text{};
  std::shared_ptr<const Data> data{};
  std::uint32_t subscription = 0;

  [[nodiscard]] std::size_t bytes() const { return data ? data->cdr.size() : text.size(); }
};

/// First in, first out. Beyond the limit the oldest data are dropped and counted, never texts.
class ClientQueue {
 public:
  /// Some seconds of every topic, and at least one map.
  static constexpr std::size_t kMaxBytes = 64U << 20U;

  explicit ClientQueue(std::size_t max_bytes = kMaxBytes) : max_bytes_(max_bytes) {}

  void push(Outgoing message);
  /// Removes the data that wait for a subscription.
  void forget(std::uint32_t subscription);
  /// The oldest message. Undefined where empty() is true.
  Outgoing pop();
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::deque<Outgoing> waiting_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace isobar::tools::foxglove
