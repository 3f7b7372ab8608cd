// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/samples.hpp"

namespace isobar {

/// Status of a BasePathChoice: plain values, trivially copyable.
struct BasePathStatus {
  SamplePath in_use = SamplePath::kLocal;
  std::uint64_t refused = 0;    ///< samples of the other path
  std::int64_t other_ns = 0;    ///< the newest of them, robot clock; 0: none
  std::uint64_t takeovers = 0;  ///< changes to the other path
};

/// The one place that decides about base stations, whatever the path. Each path (datagrams, DDS) has chosen one
/// sender already (BaseStationStream); samples of one base station on two paths come from two base stations at
/// two places. The first path heard is used. The other one takes over after kTakeoverNs without a sample; as
/// soon as the first one is back, it is used again. One thread.
class BasePathChoice {
 public:
  /// As BaseStationConfig::takeover_ns: the altimeter has reported the loss by then.
  static constexpr std::int64_t kTakeoverNs = 15'000'000'000;

  /// @return whether the sample is used
  bool check(const PressureSample& sample) noexcept {
    if (!started_) {
      started_ = true;
      first_ = sample.path;
      status_.in_use = sample.path;
    }
    if (sample.path != status_.in_use) {
      const bool is_lost = sample.stamp_ns - newest_ns_ > kTakeoverNs;
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
  [[nodiscard]] const BasePathStatus& status() const noexcept { return status_; }

 private:
  bool started_ = false;
  SamplePath first_ = SamplePath::kLocal;
  std::int64_t newest_ns_ = 0;  // of the path in use, robot clock
  BasePathStatus status_;
};

}  // namespace isobar
