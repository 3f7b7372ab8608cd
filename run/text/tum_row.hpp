// SPDX-License-Identifier: BSD-3-Clause
// Rows of the TUM trajectory format: `t x y z qx qy qz qw`, t in seconds.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "run/text/text_lines.hpp"

namespace isobar::text {

/// Pose of a moving frame in the trajectory's frame.
struct TumRow {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< unit length
};

/// The next row; nothing at the end. Blank rows and rows that start with '#' are skipped; blanks, tabs or
/// commas separate the numbers. Stamps in plain decimals are exact to 1 ns; quaternions are normalised.
/// @throws DataError "name:line: rule" when the row has not eight finite numbers or no unit quaternion
std::optional<TumRow> next_tum_row(TextLines& lines);

/// Appends a row to `text`, with its line end: stamps to 1 ns, positions to 1 um.
void append_tum_row(const TumRow& row, std::string& text);

}  // namespace isobar::text
