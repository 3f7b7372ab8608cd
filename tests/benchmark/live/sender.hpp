// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/benchmark/live/arrivals.hpp"

namespace isobar::benchmark {

/// Plays a recording from its own thread in real time and records departure times.
class Sender {
 public:
  /// Starts immediately.
  Sender(const std::filesystem::path& recording, std::uint16_t lidar_port);
  ~Sender();  ///< stops
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Stamps and times of sending on the robot clock. A scan is stamped at its end and sent with its closing
  /// packet.
  [[nodiscard]] std::vector<Event> scans() const;
  [[nodiscard]] std::vector<Event> imu_samples() const;
  /// Whether the recording has ended.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  void play(const std::filesystem::path& recording, std::uint16_t lidar_port);
  void note(std::vector<Event>& to, const Event& event);

  mutable std::mutex mutex_;
  std::vector<Event> scans_;
  std::vector<Event> imu_samples_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace isobar::benchmark
