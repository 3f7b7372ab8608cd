// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/base_clock.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "core/statistics/distribution.hpp"
#include "run/recording/sample_csv.hpp"

namespace isobar::recording {
namespace {

/// Rows read at the start of a file, and bytes at its end.
constexpr std::size_t kRowsAtStart = 200;
constexpr std::uint64_t kBytesAtEnd = 16'384;
/// Stamps farther than this from the median of their neighbours are outliers [ns].
constexpr std::int64_t kNeighbourhoodNs = 3'600'000'000'000;
/// Tolerance when the spans of two recorders are compared [ns].
constexpr std::int64_t kToleranceNs = 5'000'000'000;
/// Largest difference between two files that one recorder opens and closes together [ns]: a few samples of 10
/// Hz.
constexpr std::int64_t kTogetherNs = 300'000'000;

/// Lowest and highest of the stamps near the median.
StampSpan robust_span(std::vector<std::int64_t>& stamps_ns) {
  const std::int64_t median_ns = upper_median(stamps_ns);
  StampSpan span{median_ns, median_ns};
  for (const std::int64_t stamp_ns : stamps_ns) {
    if (std::abs(stamp_ns - median_ns) <= kNeighbourhoodNs) {
      span.first_ns = std::min(span.first_ns, stamp_ns);
      span.last_ns = std::max(span.last_ns, stamp_ns);
    }
  }
  return span;
}

template <typename Sample>
std::optional<StampSpan> span_of(text::CsvReader&& csv) {
  Tally ignored;
  Sample sample;
  std::vector<std::int64_t> stamps_ns;
  while (stamps_ns.size() < kRowsAtStart && next_sample(csv, sample, ignored, ignored)) {
    stamps_ns.push_back(sample.stamp_ns);
  }
  if (stamps_ns.empty()) {
    return std::nullopt;
  }
  StampSpan span = robust_span(stamps_ns);
  stamps_ns.clear();
  csv.skip_to_last(kBytesAtEnd);
  while (next_sample(csv, sample, ignored, ignored)) {
    stamps_ns.push_back(sample.stamp_ns);
  }
  if (!stamps_ns.empty()) {
    span.last_ns = std::max(span.last_ns, robust_span(stamps_ns).last_ns);
  }
  return span;
}

std::string seconds(std::int64_t ns) {
  char text[48];  // NOLINT(modernize-avoid-c-arrays)
  std::snprintf(text, sizeof text, "%.1f s", static_cast<double>(ns) * 1e-9);
  return text;
}

}  // namespace

std::optional<StampSpan> pressure_span(const std::filesystem::path& file) {
  return span_of<PressureSample>(open_pressure_csv(file));
}

std::optional<StampSpan> imu_span(const std::filesystem::path& file) {
  return span_of<ImuSample>(open_imu_csv(file));
}

BaseClock tie_base_clock(const std::optional<StampSpan>& robot, const std::optional<StampSpan>& base,
                         Recorders recorders) {
  if (!robot || !base) {
    return {0, "base-station clock trusted: nothing to compare it with"};
  }
  const std::int64_t start_ns = robot->first_ns - base->first_ns;
  const std::int64_t end_ns = robot->last_ns - base->last_ns;
  const std::int64_t middle_ns = start_ns + (end_ns - start_ns) / 2;
  const std::int64_t disagreement_ns = std::abs(start_ns - end_ns);
  const bool overlaps = base->first_ns <= robot->last_ns && base->last_ns >= robot->first_ns;
  const bool together =
      recorders == Recorders::kOne && disagreement_ns <= kTogetherNs && std::abs(middle_ns) > kTogetherNs;
  if (together || (!overlaps && disagreement_ns <= kToleranceNs)) {
    return {middle_ns, "base-station clock is off by " + seconds(-middle_ns) +
                           ": its file starts and ends that much away from the robot's"};
  }
  if (start_ns >= -kToleranceNs && end_ns <= kToleranceNs) {
    return {0, "base-station clock trusted: its file covers the robot's"};
  }
  if (overlaps) {
    return {0, "base-station clock trusted: its file overlaps the robot's, but does not cover it"};
  }
  if (base->length_ns() + kToleranceNs >= robot->length_ns()) {
    return {middle_ns, "base-station clock is off by about " + seconds(-middle_ns) +
                           ": its file does not overlap the robot's and is longer, so both are centred"};
  }
  return {start_ns, "base-station clock is off by about " + seconds(-start_ns) +
                        ": its file does not overlap the robot's, so the starts are put together"};
}

}  // namespace isobar::recording
