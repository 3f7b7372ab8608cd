// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/samples.hpp"

namespace isobar {

/// Status of a PathChoice: plain values, trivially copyable.
struct PathStatus {
  SamplePath in_use = SamplePath::kLocal;
  std::uint64_t refused = 0;    ///< samples of the other path
  std::int64_t other_ns = 0;    ///< the newest of them, robot clock; 0: none
  std::uint64_t takeovers = 0;  ///< changes to the other path
};

/// The one place that decides about a stream, whatever the path. Each path (datagrams, DDS) has chosen one sender
/// already; samples of one stream on two paths come from two sensors. The first path heard is used. The other one
/// takes over after a silence; as soon as the first one is back, it is used again. One thread.
class PathChoice {
 public:
  /// Silence of a base station after which the other path takes over [ns]. As BaseStationConfig::takeover_ns: the
  /// altimeter has reported the loss by then.
  static constexpr std::int64_t kBaseTakeoverNs = 15'000'000'000;
  /// The same of the robot's own sensors, as between two senders of one path.
  static constexpr std::int64_t kSensorTakeoverNs = 5'000'000'000;

  explicit PathChoice(std::int64_t takeover_ns) : takeover_ns_(takeover_ns) {}

  /// @return whether the sample is used
  template <class Sample>
  bool check(const Sample& sample) noexcept {
    if (!started_) {
      started_ = true;
      first_ = sample.path;
      status_.in_use = sample.path;
    }
    if (sample.path != status_.in_use) {
      const bool is_lost = sample.stamp_ns - newest_ns_ > takeover_ns_;
      if (sample.path != first_ && !is_lost) {
        ++status_.refused;
        status_.other_ns = sample.stamp_ns;
        return false;
      }
      status_.takeovers += sample.path != first_ ? 1 : 0;
      status_.in_use = sample.path;
    }
    newest_ns_ = sample.stamp_ns;
    return true;
  }
  [[nodiscard]] const PathStatus& status() const noexcept { return status_; }

 private:
  std::int64_t takeover_ns_;
  bool started_ = false;
  SamplePath first_ = SamplePath::kLocal;
  std::int64_t newest_ns_ = 0;  // of the path in use, robot clock
  PathStatus status_;
};

}  // namespace isobar
