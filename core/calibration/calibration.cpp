// SPDX-License-Identifier: BSD-3-Clause
#include "core/calibration/calibration.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/calibration/still_period.hpp"
#include "core/errors.hpp"
#include "core/statistics/distribution.hpp"

namespace isobar {
namespace {

// Largest difference of one value printed twice, in different units: rounding.
constexpr double kSamePa = 1e-4;

using Fold = std::span<const CalibrationPair>;

std::string number(double value, int decimals) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  return {text.data(), end.ptr};
}

CalibratedRange range_of(std::span<const Fold> folds, std::size_t without = static_cast<std::size_t>(-1)) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CalibratedRange range{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (std::size_t k = 0; k < folds.size(); ++k) {
    if (k == without) continue;
    for (const CalibrationPair& pair : folds[k]) {
      range.lowest_pa = std::min(range.lowest_pa, pair.pressure_pa);
      range.highest_pa = std::max(range.highest_pa, pair.pressure_pa);
      range.lowest_c = std::min(range.lowest_c, pair.temperature_c);
      range.highest_c = std::max(range.highest_c, pair.temperature_c);
    }
  }
  return range;
}

/// Centre and half width of the range: u and v lie within -1 … 1, where powers are best conditioned.
Compensation::Variables variables_for(const CalibratedRange& range) {
  const double half_pa = 0.5 * (range.highest_pa - range.lowest_pa);
  const double half_k = 0.5 * (range.highest_c - range.lowest_c);
  return {range.lowest_pa + half_pa, half_pa > 0.0 ? half_pa : 1.0, range.lowest_c + half_k,
          half_k > 0.0 ? half_k : 1.0};
}

/// Folds of the cross-validation: the recordings, or equal parts of a single one.
std::vector<Fold> folds_of(std::span<const CalibrationRecording> recordings, const CalibrationLimits& limits,
                           std::string& sentence) {
  std::vector<Fold> folds;
  for (const CalibrationRecording& recording : recordings) {
    if (!recording.pairs.empty()) folds.emplace_back(recording.pairs);
  }
  if (folds.size() != 1) {
    sentence = "each of the " + std::to_string(folds.size()) +
               " recordings is compensated by a fit to the others, within the range that those cover";
    return folds;
  }
  const Fold all = folds.front();
  const std::size_t count = std::max<std::size_t>(2, std::min(limits.stretches, all.size() / 32));
  folds.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = all.size() * k / count;
    folds.push_back(all.subspan(begin, all.size() * (k + 1) / count - begin));
  }
  sentence = "there is one recording only: each of " + std::to_string(count) +
             " parts is compensated by a fit to the other parts; errors on another day may be larger";
  return folds;
}

void require_a_reference(std::span<const Fold> folds, std::size_t least_pairs) {
  std::vector<double> differences;
  for (const Fold& fold : folds) {
    for (const CalibrationPair& pair : fold)
      differences.push_back(std::abs(pair.reference_pa - pair.pressure_pa));
  }
  if (differences.size() < std::max<std::size_t>(1, least_pairs)) {
    throw DataError("only " + std::to_string(differences.size()) +
                    " samples of the sensor coincide with the reference, a calibration needs " +
                    std::to_string(least_pairs));
  }
  std::sort(differences.begin(), differences.end());
  if (quantile(differences, 0.9) < kSamePa) {
    throw DataError("the reference is the sensor itself: their pressures are the same numbers");
  }
}

/// Samples of a fold within a range: outside, a fit to the other folds would extrapolate.
std::vector<CalibrationPair> within(Fold fold, const CalibratedRange& range) {
  std::vector<CalibrationPair> inside;
  std::copy_if(fold.begin(), fold.end(), std::back_inserter(inside), [&range](const CalibrationPair& pair) {
    return range.holds(pair.pressure_pa, pair.temperature_c);
  });
  return inside;
}

double mean_square(Fold fold, const Compensation& compensation) {
  double sum = 0.0;
  for (const CalibrationPair& pair : fold) {
    const double residual = pair.reference_pa - compensation(pair.pressure_pa, pair.temperature_c);
    sum += residual * residual;
  }
  return fold.empty() ? 0.0 : sum / static_cast<double>(fold.size());
}

std::string reason_to_leave_out(CompensationModel model, const CalibratedRange& range,
                                const DesignFactor::Solution& solution, const CalibrationLimits& limits) {
  const double span_k = range.highest_c - range.lowest_c;
  if (uses_temperature(model) && !(span_k >= limits.least_temperature_span_k)) {
    return "the temperature spans only " + number(span_k, 1) + " K, temperature terms need " +
           number(limits.least_temperature_span_k, 0) + " K";
  }
  if (!(solution.condition_number <= limits.largest_condition_number)) {
    return "these data cannot separate its terms";
  }
  return {};
}

std::vector<double> residuals_of(std::span<const Fold> folds, const Compensation& compensation) {
  std::vector<double> residuals;
  for (const Fold& fold : folds) {
    for (const CalibrationPair& pair : fold) {
      residuals.push_back(pair.reference_pa - compensation(pair.pressure_pa, pair.temperature_c));
    }
  }
  return residuals;
}

/// Fills the cross-validated figures of `models`; returns the weight of each fold, its share of the samples.
std::vector<double> cross_validate(std::span<const Fold> folds, std::span<const DesignFactor> factors,
                                   const Compensation::Variables& variables,
                                   std::vector<ModelResult>& models) {
  std::vector<double> weights;
  for (std::size_t k = 0; k < folds.size(); ++k) {
    const std::vector<CalibrationPair> judged = within(folds[k], range_of(folds, k));
    if (judged.empty()) continue;
    DesignFactor others(variables);
    for (std::size_t i = 0; i < folds.size(); ++i) {
      if (i != k) others.add(factors[i]);
    }
    weights.push_back(static_cast<double>(judged.size()));
    for (ModelResult& model : models) {
      if (!model.left_out.empty()) continue;
      const auto solution = others.solve(free_coefficients(model.model));
      model.fold_mean_squares_pa2.push_back(mean_square(judged, solution.compensation));
    }
  }
  const double judged = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= judged;
  for (ModelResult& model : models) {
    if (!model.left_out.empty() || weights.empty()) continue;
    model.cross_validated_rms_pa = std::sqrt(
        std::inner_product(weights.begin(), weights.end(), model.fold_mean_squares_pa2.begin(), 0.0));
  }
  return weights;
}

void warn_of_narrow_spans(Calibration& calibration, const CalibrationLimits& limits) {
  const CalibratedRange& range = calibration.range;
  const double span_k = range.highest_c - range.lowest_c;
  const double span_pa = range.highest_pa - range.lowest_pa;
  if (span_k == 0.0) {
    calibration.warnings.emplace_back(
        "the sensor has no temperature, or only one: the effect of another temperature is unknown");
  } else if (span_k < limits.narrow_temperature_span_k) {
    calibration.warnings.push_back("the temperature spans only " + number(span_k, 1) + " K (" +
                                   number(range.lowest_c, 1) + " … " + number(range.highest_c, 1) +
                                   " degC): outside, the correction at the nearest end is used");
  }
  if (span_pa < limits.narrow_pressure_span_pa) {
    calibration.warnings.push_back("the pressure spans only " + number(0.01 * span_pa, 1) + " hPa (" +
                                   number(0.01 * range.lowest_pa, 1) + " … " +
                                   number(0.01 * range.highest_pa, 1) +
                                   " hPa): outside, the correction at the nearest end is used");
  }
}

std::string name_in_text(CompensationModel model) {
  return model == CompensationModel::kNone ? "the uncompensated sensor"
                                           : std::string(kCompensationModelNames.name(model));
}

std::string reason_for(const std::vector<ModelResult>& models, std::size_t chosen, double least_gain) {
  const auto better = [](const ModelResult& a, const ModelResult& b) {
    // NaN (a model that was left out) is never better.
    return a.cross_validated_rms_pa < b.cross_validated_rms_pa || std::isnan(b.cross_validated_rms_pa);
  };
  const ModelResult& pick = models[chosen];
  const ModelResult& best = *std::min_element(models.begin(), models.end(), better);
  const auto error = [](const ModelResult& model) { return number(model.cross_validated_rms_pa, 2) + " Pa"; };
  std::string text = name_in_text(pick.model) + ": its cross-validated error is " + error(pick);
  if (&pick == &best) {
    text += " rms, the smallest of all";
  } else {
    text += " rms; the smallest is " + error(best) + " of " + name_in_text(best.model) +
            ", better by less than one standard error or " + number(100.0 * least_gain, 0) +
            " % and with more coefficients";
  }
  const auto simpler_end = models.begin() + static_cast<std::ptrdiff_t>(chosen);
  const auto simpler = std::min_element(models.begin(), simpler_end, better);
  if (simpler != simpler_end && simpler->left_out.empty()) {
    text += "; the best simpler one is " + name_in_text(simpler->model) + " with " + error(*simpler);
  }
  return text;
}

}  // namespace

std::size_t simplest_within_one_error(std::span<const ModelResult> models, std::span<const double> weights,
                                      double least_gain) {
  const std::size_t folds = weights.size();
  const auto mean = [&](const ModelResult& model) {
    return std::inner_product(weights.begin(), weights.end(), model.fold_mean_squares_pa2.begin(), 0.0);
  };
  const auto is_judged = [folds](const ModelResult& model) {
    return folds > 0 && model.fold_mean_squares_pa2.size() == folds;
  };
  const ModelResult* best = nullptr;
  for (const ModelResult& model : models) {
    if (is_judged(model) && (best == nullptr || mean(model) < mean(*best))) best = &model;
  }
  if (best == nullptr) return 0;
  double variance = 0.0;
  for (std::size_t k = 0; k < folds; ++k) {
    const double deviation = weights[k] * (best->fold_mean_squares_pa2[k] - mean(*best));
    variance += deviation * deviation;
  }
  if (folds > 1) variance *= static_cast<double>(folds) / static_cast<double>(folds - 1);
  const double not_worth = ((1.0 + least_gain) * (1.0 + least_gain) - 1.0) * mean(*best);
  const double limit = mean(*best) + std::max(std::sqrt(variance), not_worth);
  const auto found = std::find_if(models.begin(), models.end(), [&](const ModelResult& model) {
    return is_judged(model) && mean(model) <= limit;
  });
  return static_cast<std::size_t>(found - models.begin());
}

const ModelResult& Calibration::model(CompensationModel which) const {
  return models[static_cast<std::size_t>(which)];
}

CompensationConfig Calibration::config(CompensationModel which) const {
  const ModelResult& result = model(which);
  CompensationConfig config;
  config.model = which;
  config.range = range;
  config.sigma_pa = robust_sigma(result.residuals_pa);
  const Compensation::Variables& variables = result.compensation.variables();
  config.pressure_centre_pa = variables.pressure_centre_pa;
  config.pressure_scale_pa = variables.pressure_scale_pa;
  config.temperature_centre_c = variables.temperature_centre_c;
  config.temperature_scale_c = variables.temperature_scale_c;
  if (which == CompensationModel::kNone) return config;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) config.coefficients.push_back(result.compensation.centred()(i, j));
  }
  return config;
}

Calibration calibrate(std::span<const CalibrationRecording> recordings, const CalibrationLimits& limits) {
  Calibration calibration;
  const std::vector<Fold> folds = folds_of(recordings, limits, calibration.validation);
  require_a_reference(folds, limits.least_pairs);
  calibration.range = range_of(folds);
  const Compensation::Variables variables = variables_for(calibration.range);
  DesignFactor all(variables);
  std::vector<DesignFactor> factors;
  for (const Fold& fold : folds) {
    factors.emplace_back(variables).add(fold);
    all.add(factors.back());
  }
  calibration.pair_count = all.count();
  for (const auto& [model, name] : kCompensationModelNames.entries) {
    const auto solution = all.solve(free_coefficients(model));
    ModelResult result;
    result.model = model;
    result.left_out = reason_to_leave_out(model, calibration.range, solution, limits);
    result.condition_number = solution.condition_number;
    if (result.left_out.empty()) {
      result.compensation = solution.compensation;
      result.residuals_pa = residuals_of(folds, solution.compensation);
      result.residual = residual_figures(result.residuals_pa);
    }
    calibration.models.push_back(std::move(result));
  }
  const std::vector<double> weights = cross_validate(folds, factors, variables, calibration.models);
  calibration.recommended = simplest_within_one_error(calibration.models, weights, limits.least_gain);
  calibration.reason = reason_for(calibration.models, calibration.recommended, limits.least_gain);
  warn_of_narrow_spans(calibration, limits);
  return calibration;
}

}  // namespace isobar
