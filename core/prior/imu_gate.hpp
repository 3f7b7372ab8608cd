// SPDX-License-Identifier: BSD-3-Clause
// Which IMU samples are fit to be used, and what the time between them means.
#pragma once

#include <cstdint>

#include "core/prior/prior_config.hpp"
#include "core/samples.hpp"

namespace isobar {

enum class ImuStatus : std::uint8_t {
  kFirst,     ///< there was none before
  kNext,      ///< follows the one before
  kGap,       ///< follows after a gap
  kRestart,   ///< the clock jumped, and a second sample agrees
  kBadValue,  ///< refused
  kBadTime,   ///< refused
};

class ImuGate {
 public:
  explicit ImuGate(const PriorLimits& limits) : limits_(limits) {}

  ImuStatus check(const ImuSample& sample);
  /// Seconds since the sample before; 0 with kFirst and after a jump back.
  [[nodiscard]] double dt_s() const { return dt_s_; }
  [[nodiscard]] bool started() const { return started_; }
  [[nodiscard]] std::int64_t stamp_ns() const { return stamp_ns_; }

 private:
  [[nodiscard]] bool plausible(const ImuSample& sample) const;

  PriorLimits limits_;
  std::int64_t stamp_ns_ = 0;
  std::int64_t candidate_ns_ = 0;  // time of a refused sample far away, waiting for a second one
  double dt_s_ = 0.0;
  bool has_candidate_ = false;
  bool started_ = false;
};

}  // namespace isobar
