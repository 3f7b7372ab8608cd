// SPDX-License-Identifier: BSD-3-Clause
#include "run/files/corrected_trajectory.hpp"

#include <optional>
#include <string>

#include "core/errors.hpp"
#include "run/files/part_file.hpp"
#include "run/files/run_layout.hpp"
#include "run/text/text_lines.hpp"
#include "run/text/tum_row.hpp"

namespace isobar::files {
namespace {

// The next pose; nothing at the end, and at a line that a power cut has left incomplete.
std::optional<text::TumRow> next_pose(text::TextLines& lines) {
  try {
    return text::next_tum_row(lines);
  } catch (const DataError&) {
    if (lines.without_end()) return std::nullopt;
    throw;
  }
}

}  // namespace

std::uint64_t write_corrected_trajectory(const std::filesystem::path& directory, std::uint32_t session,
                                         const PoseCorrection& correction) {
  text::TextLines lines(directory / name_of_session(kTrajectoryFile, session));
  PartFile output(directory / name_of_session(kCorrectedTrajectoryFile, session));
  output.write("# t x y z qx qy qz qw, T_map_base corrected by loops\n");
  std::uint64_t poses = 0;
  std::string line;
  while (std::optional<text::TumRow> row = next_pose(lines)) {
    const Eigen::Isometry3d T_map_base = Eigen::Translation3d(row->position_m) * row->attitude;
    const Eigen::Isometry3d corrected = correction(row->stamp_ns, T_map_base);
    row->position_m = corrected.translation();
    row->attitude = Eigen::Quaterniond(corrected.linear()).normalized();
    line.clear();
    text::append_tum_row(*row, line);
    output.write(line);
    ++poses;
  }
  output.close();
  return poses;
}

}  // namespace isobar::files
