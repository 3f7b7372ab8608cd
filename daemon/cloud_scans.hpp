// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/cloud/cloud_decoder.hpp"
#include "run/files/run_output.hpp"
#include "run/recording/cloud_file.hpp"

namespace isobar {

/// Scans of the clouds of a recording. One thread.
class CloudScans {
 public:
  explicit CloudScans(const LidarLimits& limits) : decoder_(limits) {}

  /// Decodes a cloud.
  /// @param scan filled, its stamps on the robot's clock
  /// @return false for a cloud that is refused and counted: it breaks a rule, or is not later than the one before
  bool decode(const recording::CloudRecord& cloud, Scan& scan);

  [[nodiscard]] const CloudDecoder& decoder() const { return decoder_; }
  [[nodiscard]] std::uint64_t scans() const { return scans_; }
  /// Counters that are not zero, for the run's status.
  [[nodiscard]] std::vector<files::RunCount> counts() const;
  /// What the clouds were found to hold, for a note; empty without a good one.
  [[nodiscard]] std::string sentence() const;

 private:
  CloudDecoder decoder_;
  std::vector<CloudField> fields_;
  std::string first_rule_;  // that was broken
  std::uint64_t late_ = 0;
  std::uint64_t scans_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace isobar
