// SPDX-License-Identifier: BSD-3-Clause
// A recording to be played, and a reader of the shared memory of an isobard in another process.
#pragma once

#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/clock/robot_clock.hpp"
#include "ipc/shared_memory.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test {

/// A simulated drive with its configuration, made once.
struct Drive {
  std::filesystem::path folder;
  std::string recording;
  std::string config;
  /// @param name of the folder for both, in the folder for temporary files
  /// @param seconds length of the drive
  explicit Drive(const std::string& name, const std::string& seconds = "20")
      : folder(std::filesystem::temp_directory_path() / name),
        recording(folder / "recording"),
        config(folder / "isobar.toml") {
    std::filesystem::create_directories(folder);
    ChildProcess simulate({ISOBAR_PROGRAM, "simulate", "stairs-demo", "--seed", "5", "--short",
                           "--stop-after", seconds, "--out", recording});
    REQUIRE(simulate.wait(std::chrono::seconds(300)) == 0);
    ChildProcess show(
        {"/bin/sh", "-c",
         std::string(ISOBAR_PROGRAM) + " config show --sensors-of " + recording + " >" + config});
    REQUIRE(show.wait(std::chrono::seconds(20)) == 0);
  }
};

/// A pose, and when it was received.
struct Pose {
  PoseEstimate estimate;
  std::int64_t received_ns = 0;
};

/// A reader of shared memory outside isobard. A process can attach only once, so that all tests share one run
/// of isobard.
class Tap {
 public:
  /// Collects messages for `duration`.
  void gather(std::chrono::milliseconds duration) {
    const auto end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      REQUIRE(waiter_.wait_for(std::chrono::milliseconds(20)) != ipc::Waiter::Event::kStopped);
      while (const auto scan = scans_.take()) scan_ends_ns.push_back(scan->end_stamp_ns);
      while (const auto pose = poses_.take()) poses.push_back({*pose, RobotClock::now_ns()});
      if (const auto report = reports_.take_latest()) health = *report;
    }
  }
  [[nodiscard]] const ipc::HealthEntry* entry(const std::string& name) const {
    for (std::uint32_t i = 0; i < health.entry_count; ++i) {
      if (name == health.entries[i].name) return &health.entries[i];
    }
    return nullptr;
  }
  void forget() {
    scan_ends_ns.clear();
    poses.clear();
  }

  std::vector<std::int64_t> scan_ends_ns;
  std::vector<Pose> poses;
  ipc::HealthReport health;

 private:
  ipc::Attachment attachment_{"live-test", std::chrono::seconds(10)};
  ipc::Subscriber<Scan> scans_{ipc::topics::kLidarScan};
  ipc::Subscriber<PoseEstimate> poses_{ipc::topics::kPose};
  ipc::Subscriber<ipc::HealthReport> reports_{ipc::topics::kHealth};
  ipc::Waiter waiter_{&scans_.raw(), &poses_.raw(), &reports_.raw()};
};

/// Poses are in order of time. Successive ones differ by at most 2 m/s times the elapsed time plus
/// `correction_m`, the largest correction of a prior by the registration.
inline void check_steady(const std::vector<Pose>& poses, double correction_m) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const PoseEstimate& before = poses[i - 1].estimate;
    const PoseEstimate& now = poses[i].estimate;
    CHECK(now.stamp_ns > before.stamp_ns);
    const double elapsed_s = static_cast<double>(now.stamp_ns - before.stamp_ns) * 1e-9;
    CHECK((now.T_map_base.translation() - before.T_map_base.translation()).norm() <
          correction_m + 2.0 * elapsed_s);
  }
}

}  // namespace isobar::test
