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

/// What is known of the two files.
enum class Recorders : std::uint8_t {
  kOne,    ///< one recorder opened and closed both
  kApart,  ///< each has its own
};

/// Offset of the base station's clock, from the spans of the two files of one run. A clock is corrected only with evidence:
/// - one recorder, and starts and ends differ by the same amount within 0.3 s: that amount;
/// - the spans share no time, so that both clocks cannot be right: starts and ends differ by the same amount within 5 s:
///   that amount; the base station's is longer: the spans are centred on each other; else the starts are aligned;
/// - otherwise 0, the clock is trusted: what the files' lengths say is no evidence.
/// Errors of a few seconds cost little: weather changes the pressure by about 0.01 Pa/s at most.
BaseClock tie_base_clock(const std::optional<StampSpan>& robot, const std::optional<StampSpan>& base,
                         Recorders recorders = Recorders::kOne);

}  // namespace isobar::recording
