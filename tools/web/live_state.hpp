// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "tools/web/pose_rows.hpp"

namespace isobar::web {

/// Kinds of live events, of which only the newest counts.
enum class Topic : std::uint8_t { kLink, kStatus, kFloors, kSettings, kMap, kAction };
inline constexpr std::size_t kTopics = 6;

/// What one viewer has been sent. All that the server keeps of a viewer.
struct Cursor {
  std::array<std::uint64_t, kTopics> versions{};
  std::uint64_t pose = 0;
};

/// The newest of everything from the running isobard, written by one thread and read by those of the viewers. A viewer that
/// reads slowly misses poses, and holds up nobody.
class LiveState {
 public:
  /// Poses that wait for a viewer: three seconds at 10 Hz.
  static constexpr std::size_t kWaitingPoses = 30;
  /// Poses of the history: half an hour at 10 Hz, and all of a longer time at lower rates.
  static constexpr std::size_t kHistory = 18'000;

  /// Replaces the newest event of a topic. Equal ones are not sent again, except for statuses.
  void put(Topic topic, std::string json);
  /// @param json the pose for viewers
  void add_pose(const PoseRow& row, std::string json);
  /// Another map frame: the history begins anew.
  void forget_poses();

  /// Waits for what is new to a viewer, and appends it to `events` as server-sent events (WHATWG HTML, 9.2).
  /// @return false when nothing has come within the time
  bool wait_for_news(Cursor& cursor, std::chrono::milliseconds timeout, std::string& events);
  /// Wakes all waiting threads; later waits return at once.
  void stop();
  [[nodiscard]] bool stopped() const;

  [[nodiscard]] std::vector<PoseRow> history() const;
  /// Newest event of a topic; empty: none.
  [[nodiscard]] std::string newest(Topic topic) const;

 private:
  struct Slot {
    std::uint64_t version = 0;
    std::string json;
  };
  void append_news(Cursor& cursor, std::string& events) const;

  mutable std::mutex mutex_;
  std::condition_variable news_;
  bool stopped_ = false;
  std::array<Slot, kTopics> slots_;
  std::uint64_t pose_count_ = 0;  ///< of all poses so far; the newest is poses_.back()
  std::deque<std::string> poses_;
  ThinnedRows<PoseRow> history_{kHistory};
};

}  // namespace isobar::web
