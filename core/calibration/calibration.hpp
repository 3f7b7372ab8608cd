// SPDX-License-Identifier: BSD-3-Clause
// Fits all models of pressure compensation to a sensor beside a reference, and says which one to use.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/altitude/sensor_compensation.hpp"
#include "core/calibration/design_factor.hpp"
#include "core/calibration/residual_figures.hpp"

namespace isobar {

/// One stretch of samples in order of time.
struct CalibrationRecording {
  std::string name;
  std::vector<CalibrationPair> pairs;
};

struct CalibrationLimits {
  /// Fewer common moments are no calibration: sixteen coefficients could follow their noise.
  std::size_t least_pairs = 50;
  /// Temperature terms need this span [K]: below it 1 K of error in the reference's place is more than what
  /// the terms describe.
  double least_temperature_span_k = 3.0;
  /// Spans below which the result is worth a warning: a tenth of what a robot meets in a year [K], and the
  /// weather of a day [Pa].
  double narrow_temperature_span_k = 15.0;
  double narrow_pressure_span_pa = 1'000.0;
  /// A model whose terms are less distinct than this in the data is left out.
  double largest_condition_number = 1e6;
  /// A single recording is cut into so many stretches of equal length for cross-validation.
  std::size_t stretches = 8;
  /// Gains in the cross-validated error below this share are not worth a coefficient: 1 % of 4 Pa, taken as
  /// squares, is 0.6 Pa of systematic error.
  double least_gain = 0.01;
};

struct ModelResult {
  CompensationModel model = CompensationModel::kNone;
  std::string left_out;  ///< why it was not fitted; empty: it was
  Compensation compensation;
  double condition_number = 1.0;
  std::vector<double> residuals_pa;  ///< of all pairs, recording after recording
  ResidualFigures residual;
  /// Root of the mean square residual of recordings that the fit did not know; NaN where it cannot be had.
  double cross_validated_rms_pa = std::numeric_limits<double>::quiet_NaN();
  /// Mean square of each fold that was left out [Pa^2].
  std::vector<double> fold_mean_squares_pa2;
};

struct Calibration {
  std::vector<ModelResult> models;  ///< in the order of kCompensationModels
  std::size_t recommended = 0;      ///< index in `models`
  std::string reason;               ///< a sentence
  std::vector<std::string> warnings;
  std::string validation;  ///< what was left out in cross-validation, a sentence
  std::size_t pair_count = 0;
  CalibratedRange range;

  [[nodiscard]] const ModelResult& model(CompensationModel which) const;
  /// What the daemon loads, with the white noise of a sample from the model's residuals.
  [[nodiscard]] CompensationConfig config(CompensationModel which) const;
};

/// Throws DataError: too few pairs, or a reference that is the sensor itself. Recordings without pairs are
/// left out.
Calibration calibrate(std::span<const CalibrationRecording> recordings, const CalibrationLimits& limits = {});

/// Of models with these folds' mean squares (weights: share of the samples), the one to use: the first in
/// order (simplest first) that is not worse than the best by more than one standard error of the best's mean
/// over the folds (Breiman et al. 1984), or by more than `least_gain` of its rms. Models without folds are
/// passed over.
std::size_t simplest_within_one_error(std::span<const ModelResult> models, std::span<const double> weights,
                                      double least_gain);

}  // namespace isobar
