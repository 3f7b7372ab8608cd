// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/benchmark/live/arrivals.hpp"

namespace isobar::benchmark {

/// Plays a recording from a thread of its own, as punctually as the machine allows, and notes what left when.
class Sender {
 public:
  /// Starts at once.
  Sender(const std::filesystem::path& recording, std::uint16_t lidar_port);
  ~Sender();  ///< stops
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Scans: their end, and when the packet that closes each was sent. IMU samples: their stamp, and when they
  /// were sent. Stamps of this run, robot clock.
  [[nodiscard]] std::vector<Event> scans() const;
  [[nodiscard]] std::vector<Event> imu_samples() const;
  /// The recording is at its end.
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
