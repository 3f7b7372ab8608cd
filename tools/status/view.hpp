// SPDX-License-Identifier: BSD-3-Clause
// A health report as a screen of text and as JSON.
#pragma once

#include <string>

#include "ipc/topics.hpp"

namespace isobar::tools {

/// A report older than this comes from an isobard that hangs [s].
inline constexpr double kOldReportS = 5.0;

struct ViewOptions {
  bool color = false;  ///< terminal colours for the levels
  bool all = false;    ///< all health entries, not only those that are not ok
};

/// One screen of at most 80 columns: health first, then sensors, pose, height, map, stages.
/// @param age_s since the report was made; above kOldReportS the first line is the error that it is old
[[nodiscard]] std::string status_text(const ipc::HealthReport& report, double age_s,
                                      const ViewOptions& options);

/// The same as one line of JSON, with the fields of docs/health.md; figures that do not exist are null.
/// `level` and `summary` of an old report are those of the error that it is old.
[[nodiscard]] std::string status_json(const ipc::HealthReport& report, double age_s);

/// Level and text of the first line.
struct Headline {
  ipc::HealthLevel level = ipc::HealthLevel::kStale;
  std::string text;
};
[[nodiscard]] Headline headline_of(const ipc::HealthReport& report, double age_s);

}  // namespace isobar::tools
