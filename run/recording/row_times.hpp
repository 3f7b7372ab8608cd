// SPDX-License-Identifier: BSD-3-Clause
// Times of a log's rows where its clock is coarse or was set.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/samples.hpp"

namespace isobar::recording {

/// What was done to the rows of a log.
struct RowTimes {
  std::uint64_t late = 0;          ///< rows dropped: older than rows before, which go on after them
  std::uint64_t repeated = 0;      ///< rows dropped: the time of the row before, in a log with a fine clock
  std::uint64_t spread = 0;        ///< rows whose time was spread over the interval of a coarse clock
  std::int64_t interval_ns = 0;    ///< of the coarse clock
  std::uint64_t steps_back = 0;    ///< times that the clock was set back
  std::int64_t first_step_ns = 0;  ///< by how much, at the first: the time that it repeats
  std::size_t first_step_row = 0;  ///< index of the first row after it
};

/// Brings rows into ascending times:
/// - a clock that shows whole seconds (minutes, tenths, hundredths) gives several rows the same time: they are spread evenly
///   over the interval that it shows;
/// - a clock that is set back goes on as a new piece: its rows follow the last one before by one interval, and so on, for
///   what a sensor measures does not wait for the clock. Steps are told from late rows, which are dropped, by rows that
///   follow the step;
/// - a single row far in the future is dropped.
/// @param rows in the order of the file, stamps as written; their order stays
RowTimes straighten_times(std::vector<PressureSample>& rows);

}  // namespace isobar::recording
