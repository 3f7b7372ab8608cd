// SPDX-License-Identifier: BSD-3-Clause
// Fit of all models of pressure compensation to a sensor beside a reference, and the recommended model.
#pragma once

#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/altitude/sensor_compensation.hpp"
#include "core/calibration/design_factor.hpp"
#include "core/calibration/residual_figures.hpp"

namespace isobar {

/// One recording, in order of time.
struct CalibrationRecording {
  std::string name;
  std::vector<CalibrationPair> pairs;
};

/// Limits of a calibration.
struct CalibrationLimits {
  /// Smallest number of pairs: with fewer, sixteen coefficients would fit the noise.
  std::size_t least_pairs = 50;
  /// Smallest temperature span for temperature terms [K]: below it, an error of 1 K between the sensor's and
  /// the reference's place exceeds their effect.
  double least_temperature_span_k = 3.0;
  /// Spans below which the result carries a warning: a tenth of a robot's yearly range [K], and a day of
  /// weather [Pa].
  double narrow_temperature_span_k = 15.0;
  double narrow_pressure_span_pa = 1'000.0;
  /// Largest condition number of a fitted model: above it the data cannot separate its terms.
  double largest_condition_number = 1e6;
  /// Number of equal parts into which a single recording is cut for cross-validation.
  std::size_t stretches = 8;
  /// Smallest relative gain in the cross-validated rms that justifies a more complex model: 1 % of 4 Pa, as a
  /// difference of squares, is 0.6 Pa of systematic error.
  double least_gain = 0.01;
};

/// Fit of one model.
struct ModelResult {
  CompensationModel model = CompensationModel::kNone;
  std::string left_out;  ///< reason why it was not fitted; empty: it was fitted
  Compensation compensation;
  double condition_number = 1.0;
  std::vector<double> residuals_pa;  ///< of all pairs, recording after recording
  ResidualFigures residual;
  /// Rms residual in cross-validation (on data left out of the fit); NaN if not available.
  double cross_validated_rms_pa = std::numeric_limits<double>::quiet_NaN();
  /// Mean square residual of each fold, left out of the fit [Pa^2].
  std::vector<double> fold_mean_squares_pa2;
};

/// Number of free coefficients of a model.
inline int free_coefficient_count(CompensationModel model) { return std::popcount(free_coefficients(model)); }

/// Result for all models.
struct Calibration {
  std::vector<ModelResult> models;  ///< in the order of kCompensationModelNames
  std::size_t recommended = 0;      ///< index in `models`
  std::string reason;               ///< for the recommendation, a sentence
  std::vector<std::string> warnings;
  std::string validation;  ///< how the cross-validation was done, a sentence
  std::size_t pair_count = 0;
  CalibratedRange range;

  [[nodiscard]] const ModelResult& model(CompensationModel which) const;
  /// Compensation to load into the daemon; sigma_pa is the white noise of the model's residuals.
  [[nodiscard]] CompensationConfig config(CompensationModel which) const;
};

/// Fits and cross-validates every model. Recordings without pairs are left out.
/// @throws DataError when there are too few pairs or the reference is the sensor itself
Calibration calibrate(std::span<const CalibrationRecording> recordings, const CalibrationLimits& limits = {});

/// One-standard-error rule (Breiman et al. 1984): index of the first (simplest) model whose mean square over
/// the folds exceeds the best model's by at most one standard error of that mean, or whose rms exceeds the
/// best by at most the share `least_gain`. `weights`: share of the samples in each fold. Models without folds
/// are skipped.
std::size_t simplest_within_one_error(std::span<const ModelResult> models, std::span<const double> weights,
                                      double least_gain);

}  // namespace isobar
