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

/// Span of a sensor's CSV file from its first and last rows, absurd stamps left out; nothing if it has no
/// good row.
std::optional<StampSpan> pressure_span(const std::filesystem::path& file);
std::optional<StampSpan> imu_span(const std::filesystem::path& file);

/// Ties the base station's clock to the robot's. Both record the same run, so:
/// - starts and ends that differ by the same amount: that amount is the clock's offset. The same means within
///   0.3 s for an offset of at least 0.3 s, within 5 s for one of at least 5 s;
/// - a base-station span that covers the robot's, or else overlaps it: its clock is trusted;
/// - a longer span that does not cover it: centred on the robot's;
/// - a shorter span without overlap: the starts are put together.
/// Errors of some seconds cost little: weather changes the pressure by about 0.01 Pa/s at most.
BaseClock tie_base_clock(const std::optional<StampSpan>& robot, const std::optional<StampSpan>& base);

}  // namespace isobar::recording
