// SPDX-License-Identifier: BSD-3-Clause
// Where a report comes from: program, machine, date, and the settings in which the compared runs differ.
#pragma once

#include <string>
#include <vector>

#include "run/evaluation/evaluated_run.hpp"

namespace isobar::report {

/// "isobar 0.1.0 (2539df3), Intel Xeon …, 2 cores, 2026-11-30 12:00 UTC".
std::string provenance_line();

/// A setting that is not equal in all runs.
struct DifferingSetting {
  std::string key;
  std::vector<std::string>
      values;  ///< one a method, as TOML writes it; empty: the run's settings are unknown
};

/// By the settings.toml beside each trajectory; none where fewer than two runs have one that can be read.
std::vector<DifferingSetting> differing_settings(const evaluation::EvaluatedRun& run);

/// The same as a table with its heading; empty without differences.
std::string settings_section(const evaluation::EvaluatedRun& run);

}  // namespace isobar::report
