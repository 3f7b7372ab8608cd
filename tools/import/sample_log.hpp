// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/samples.hpp"

namespace isobar::tools {

/// Samples of a log file that is no container of messages.
struct SampleLog {
  std::string type;  ///< "CSV", "VN-100", "Xsens", "ULog", "dataflash"
  std::vector<ImuSample> imu;
  std::vector<PressureSample> pressure;
  /// The stamps count from 1970; else from the sensor's start.
  bool has_date = false;
  std::vector<std::string> notes;

  /// Adds to all stamps.
  void shift(std::int64_t by_ns);
};

enum class LogContent : std::uint8_t { kAny, kImu, kPressure };

/// Whether a file is a log of a form that tells itself: ULog, dataflash, the bytes of a VN-100 or an Xsens.
[[nodiscard]] bool is_sample_log(const std::filesystem::path& file);

/// Reads a log: an autopilot's; the bytes of a VN-100's or Xsens' serial line; else a CSV, as an IMU's
/// (docs/files-and-formats.md) or as a pressure log of any logger.
/// @param wanted what a CSV holds
/// @param rate_hz of readings that carry no time of their own; 0: unknown
/// @throws DataError when nothing is found in it; UsageError naming --rate where readings tell no time
[[nodiscard]] SampleLog read_sample_log(const std::filesystem::path& file, LogContent wanted, double rate_hz);

}  // namespace isobar::tools
