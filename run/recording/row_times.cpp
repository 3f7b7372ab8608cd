// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/row_times.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace isobar::recording {
namespace {

// Intervals that clocks of loggers show, coarsest first [ns]. Times that repeat within a finer one are repeats.
constexpr std::array<std::int64_t, 4> kShownIntervalsNs{60'000'000'000, 1'000'000'000, 100'000'000,
                                                        10'000'000};
// Times after a step back that confirm it.
constexpr std::size_t kConfirmingTimes = 10;
// Steps up to so many intervals are regular.
constexpr std::int64_t kRegularIntervals = 3;
// A single time farther ahead, in intervals, is wrong.
constexpr std::int64_t kFarAheadIntervals = 10;

/// Successive rows with one stamp.
struct Run {
  std::int64_t stamp_ns;
  std::size_t first;
  std::size_t count;
};

std::vector<Run> runs_of(const std::vector<PressureSample>& rows) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (runs.empty() || runs.back().stamp_ns != rows[k].stamp_ns) {
      runs.push_back({rows[k].stamp_ns, k, 0});
    }
    ++runs.back().count;
  }
  return runs;
}

/// Median of the steps forward; 0 without one.
std::int64_t usual_step_ns(const std::vector<Run>& runs) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const std::int64_t step_ns = runs[k].stamp_ns - runs[k - 1].stamp_ns;
    if (step_ns > 0) steps_ns.push_back(step_ns);
  }
  if (steps_ns.empty()) return 0;
  const auto middle = steps_ns.begin() + static_cast<std::ptrdiff_t>(steps_ns.size() / 2);
  std::nth_element(steps_ns.begin(), middle, steps_ns.end());
  return *middle;
}

std::int64_t shown_interval_ns(const std::vector<Run>& runs) {
  for (const std::int64_t interval_ns : kShownIntervalsNs) {
    if (std::all_of(runs.begin(), runs.end(),
                    [&](const Run& run) { return run.stamp_ns % interval_ns == 0; })) {
      return interval_ns;
    }
  }
  return 0;
}

using Pieces = std::vector<std::vector<Run>>;

/// Divides the runs at the steps back of the clock; drops late ones.
class Divider {
 public:
  explicit Divider(const std::vector<Run>& runs, RowTimes& found)
      : runs_(runs), usual_ns_(usual_step_ns(runs)), found_(found) {}

  Pieces divide() {
    Pieces pieces(1);
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      std::vector<Run>& piece = pieces.back();
      if (piece.empty() || runs_[k].stamp_ns > piece.back().stamp_ns) {
        piece.push_back(runs_[k]);
        continue;
      }
      if (was_far_ahead(piece, runs_[k])) {
        found_.late += piece.back().count;
        piece.back() = runs_[k];
        continue;
      }
      const std::size_t late = late_runs(k, piece.back().stamp_ns);
      for (std::size_t j = k; j < k + late; ++j) found_.late += runs_[j].count;
      if (late > 0) {
        k += late - 1;
        continue;
      }
      if (found_.steps_back++ == 0) found_.first_step_row = runs_[k].first;
      pieces.push_back({runs_[k]});
    }
    return pieces;
  }

 private:
  /// The last run was alone ahead of its neighbours.
  [[nodiscard]] bool was_far_ahead(const std::vector<Run>& piece, const Run& next) const {
    if (piece.size() < 2) return false;
    const std::int64_t before_ns = piece[piece.size() - 2].stamp_ns;
    return next.stamp_ns > before_ns && next.stamp_ns - before_ns <= kRegularIntervals * usual_ns_ &&
           piece.back().stamp_ns - before_ns > kFarAheadIntervals * usual_ns_;
  }

  /// Number of runs from `k` on that are late; 0: the clock was set back. Late ones are followed by a jump to a time after
  /// the newest, the time after a step comes there regularly or not soon.
  [[nodiscard]] std::size_t late_runs(std::size_t k, std::int64_t newest_ns) const {
    std::size_t j = k + 1;
    while (j < runs_.size() && j - k < kConfirmingTimes && runs_[j].stamp_ns > runs_[j - 1].stamp_ns &&
           runs_[j].stamp_ns <= newest_ns) {
      ++j;
    }
    const std::size_t count = j - k;
    if (count >= kConfirmingTimes) return 0;
    const bool ends = j == runs_.size() || runs_[j].stamp_ns <= runs_[j - 1].stamp_ns;
    if (ends) return count > 1 ? 0 : count;
    const bool regular = runs_[j].stamp_ns - runs_[j - 1].stamp_ns <= kRegularIntervals * usual_ns_;
    return count > 1 && regular ? 0 : count;
  }

  const std::vector<Run>& runs_;
  std::int64_t usual_ns_;
  RowTimes& found_;
};

/// Writes the rows of a piece with their times.
class Spreader {
 public:
  Spreader(const std::vector<PressureSample>& rows, std::int64_t interval_ns, RowTimes& found)
      : rows_(rows), interval_ns_(interval_ns), found_(found) {}

  std::vector<PressureSample> spread(const std::vector<Run>& piece) {
    std::vector<PressureSample> out;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Run& run = piece[k];
      if (run.count > 1 && interval_ns_ == 0) {
        found_.repeated += run.count - 1;
        out.push_back(rows_[run.first]);
        continue;
      }
      found_.spread += run.count > 1 ? run.count : 0;
      const auto count = static_cast<std::int64_t>(run.count);
      std::int64_t step_ns = span_ns(piece, k) / count;
      std::int64_t begin_ns = run.stamp_ns;
      // The log began and ended within an interval of its clock: its rows are as far apart as their neighbours.
      if (k == 0 && piece.size() > 1 && piece[1].count > run.count) {
        step_ns = span_ns(piece, 1) / static_cast<std::int64_t>(piece[1].count);
        begin_ns = run.stamp_ns + span_ns(piece, 0) - count * step_ns;
      } else if (k > 0 && k + 1 == piece.size() && piece[k - 1].count > run.count) {
        step_ns = span_ns(piece, k - 1) / static_cast<std::int64_t>(piece[k - 1].count);
      }
      for (std::int64_t j = 0; j < count; ++j) {
        out.push_back(rows_[run.first + static_cast<std::size_t>(j)]);
        out.back().stamp_ns = begin_ns + j * step_ns;
      }
    }
    return out;
  }

 private:
  /// Time over which the rows of a run are spread.
  [[nodiscard]] std::int64_t span_ns(const std::vector<Run>& piece, std::size_t k) const {
    if (k + 1 == piece.size()) return interval_ns_;
    return std::min(interval_ns_, piece[k + 1].stamp_ns - piece[k].stamp_ns);
  }

  const std::vector<PressureSample>& rows_;
  std::int64_t interval_ns_;
  RowTimes& found_;
};

std::int64_t median_interval_ns(const std::vector<PressureSample>& rows) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t k = 1; k < rows.size(); ++k) steps_ns.push_back(rows[k].stamp_ns - rows[k - 1].stamp_ns);
  if (steps_ns.empty()) return 1;
  const auto middle = steps_ns.begin() + static_cast<std::ptrdiff_t>(steps_ns.size() / 2);
  std::nth_element(steps_ns.begin(), middle, steps_ns.end());
  return std::max<std::int64_t>(1, *middle);
}

}  // namespace

RowTimes straighten_times(std::vector<PressureSample>& rows) {
  RowTimes found;
  const std::vector<Run> runs = runs_of(rows);
  if (runs.empty()) return found;
  found.interval_ns = shown_interval_ns(runs);
  Spreader spreader(rows, found.interval_ns, found);
  std::vector<PressureSample> straight;
  for (const std::vector<Run>& runs_of_piece : Divider(runs, found).divide()) {
    std::vector<PressureSample> piece = spreader.spread(runs_of_piece);
    if (!straight.empty()) {
      const std::int64_t interval_ns = median_interval_ns(piece.size() > 1 ? piece : straight);
      const std::int64_t shift_ns = straight.back().stamp_ns + interval_ns - piece.front().stamp_ns;
      if (found.first_step_ns == 0) found.first_step_ns = shift_ns;
      for (PressureSample& row : piece) row.stamp_ns += shift_ns;
    }
    straight.insert(straight.end(), piece.begin(), piece.end());
  }
  rows = std::move(straight);
  return found;
}

}  // namespace isobar::recording
