// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "run/recording/recording_reader.hpp"

namespace isobar::recording {

/// First and last stamp of a file.
struct StampSpan {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  [[nodiscard]] std::int64_t length_ns() const { return last_ns - first_ns; }
};

/// Time span of a sensor's CSV file, from its first and last rows without outliers; nothing without a good
/// row.
/// @throws DataError when the file cannot be read or lacks a column
std::optional<StampSpan> pressure_span(const std::filesystem::path& file);
std::optional<StampSpan> imu_span(const std::filesystem::path& file);

/// Offset of the base station's clock, from the spans of the two files of one run:
/// - starts and ends differ by the same amount: that amount. "Same" is within 0.3 s for an offset of at least
///   0.3 s, within 5 s for one of at least 5 s;
/// - the base station's span covers or overlaps the robot's: 0, the clock is trusted;
/// - it is longer and does not cover it: the spans are centred on each other;
/// - it is shorter and does not overlap it: the starts are aligned.
/// Errors of a few seconds cost little: weather changes the pressure by about 0.01 Pa/s at most.
BaseClock tie_base_clock(const std::optional<StampSpan>& robot, const std::optional<StampSpan>& base);

}  // namespace isobar::recording
