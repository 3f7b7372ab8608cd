// SPDX-License-Identifier: BSD-3-Clause
// The page of the sensitivity experiment: heights against time, and their errors.
#pragma once

#include <string>
#include <vector>

#include "core/calibration/staircase.hpp"

namespace isobar::report {

/// Errors of one kind of one sensor over all runs, and the figures of each run.
struct ErrorRow {
  std::string sensor;
  bool filtered = false;
  bool plateau_means = false;  ///< of the mean of each level; else of every settled sample
  std::vector<double> errors_m;
  std::vector<ErrorFigures> runs;
};

/// Height against time of one sensor pair in one run.
struct HeightPicture {
  std::string sensor;
  HeightTrack raw;
  HeightTrack filtered;
  std::vector<Plateau> plateaus;
  double lag_s = 0.0;
};

struct SensitivityExperiment {
  std::string title;    ///< "Ten steps of 3 cm"
  std::string caption;  ///< source and conditions of the data
  std::vector<HeightPicture> pictures;
  std::vector<ErrorRow> rows;
};

struct SensitivityReport {
  std::string title;
  std::string description;
  std::string command;
  std::vector<SensitivityExperiment> experiments;
};

/// A figure's median over the runs and its value in the worst run; NaN without runs.
struct OverRuns {
  double median_m = 0.0;
  double worst_m = 0.0;
};
OverRuns over_runs(const ErrorRow& row, double ErrorFigures::*figure);

/// "filtered, every sample" and the like.
std::string row_name(const ErrorRow& row);

std::string render_sensitivity_report(const SensitivityReport& report);

}  // namespace isobar::report
