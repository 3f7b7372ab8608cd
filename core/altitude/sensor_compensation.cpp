// SPDX-License-Identifier: BSD-3-Clause
#include "core/altitude/sensor_compensation.hpp"

#include <algorithm>
#include <cmath>

#include "core/squared.hpp"

namespace isobar {
namespace {

// Largest plausible correction: ten times the absolute accuracy of the poorest chips. A larger one comes from
// another sensor's file or a wrong unit.
constexpr double kLargestCorrectionPa = 5'000.0;
constexpr std::size_t kCoefficients = 16;

Compensation::Variables variables_of(const CompensationConfig& config) {
  return {config.pressure_centre_pa, config.pressure_scale_pa, config.temperature_centre_c,
          config.temperature_scale_c};
}

Compensation compensation_of(const CompensationConfig& config) {
  if (config.coefficients.size() != kCoefficients) return {};
  Eigen::Matrix4d centred;
  for (std::size_t k = 0; k < kCoefficients; ++k) {
    centred(static_cast<Eigen::Index>(k / 4), static_cast<Eigen::Index>(k % 4)) = config.coefficients[k];
  }
  return {centred, variables_of(config)};
}

bool has_foreign_coefficient(const CompensationConfig& config) {
  // c_00 and c_10 are set in every model: p_cal = p_raw + correction, and they hold p_raw.
  const CompensationMask mask = free_coefficients(config.model) | coefficient(0, 0) | coefficient(1, 0);
  for (std::size_t k = 0; k < kCoefficients; ++k) {
    if (((mask >> k) & 1U) == 0 && config.coefficients[k] != 0.0) return true;
  }
  return false;
}

bool has_small_corrections(const CompensationConfig& config) {
  constexpr int kSteps = 8;
  const Compensation compensation = compensation_of(config);
  const CalibratedRange& range = config.range;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double p = range.lowest_pa + (range.highest_pa - range.lowest_pa) * i / kSteps;
      const double t = range.lowest_c + (range.highest_c - range.lowest_c) * j / kSteps;
      if (!(std::abs(compensation(p, t) - p) <= kLargestCorrectionPa)) return false;
    }
  }
  return true;
}

}  // namespace

double compensated_pa(const Compensation& compensation, const CalibratedRange& range, double pressure_pa,
                      double temperature_c) {
  const double p = std::clamp(pressure_pa, range.lowest_pa, range.highest_pa);
  const double t = std::clamp(temperature_c, range.lowest_c, range.highest_c);
  return pressure_pa + (compensation(p, t) - p);
}

const char* broken_compensation_rule(const CompensationConfig& config, const char** key) {
  const auto broken = [key](const char* name, const char* rule) {
    if (key != nullptr) *key = name;
    return rule;
  };
  if (config.model == CompensationModel::kNone) return nullptr;
  if (config.coefficients.size() != kCoefficients) return broken("coefficients", "must be sixteen numbers");
  if (has_foreign_coefficient(config)) {
    return broken("coefficients", "must be zero where the model has no coefficient");
  }
  if (!(config.range.lowest_pa <= config.range.highest_pa)) {
    return broken("lowest_pressure_pa", "must not be above highest_pressure_pa");
  }
  if (!(config.range.lowest_c <= config.range.highest_c)) {
    return broken("lowest_temperature_c", "must not be above highest_temperature_c");
  }
  if (!has_small_corrections(config)) {
    return broken("coefficients", "must correct by at most 5000 Pa within the calibrated range");
  }
  return nullptr;
}

SensorCompensation::SensorCompensation(const CompensationConfig& config)
    : active_(config.model != CompensationModel::kNone && broken_compensation_rule(config) == nullptr),
      uses_temperature_(uses_temperature(config.model)),
      compensation_(compensation_of(config)),
      range_(config.range),
      variance_pa2_(config.sigma_pa > 0.0 ? squared(config.sigma_pa)
                                          : std::numeric_limits<double>::quiet_NaN()),
      temperature_c_(0.5 * (config.range.lowest_c + config.range.highest_c)) {
  if (uses_temperature_) return;
  range_.lowest_c = -std::numeric_limits<double>::infinity();  // the temperature has no effect
  range_.highest_c = std::numeric_limits<double>::infinity();
}

SensorCompensation::Result SensorCompensation::apply(PressureSample& sample) {
  if (!active_ || !std::isfinite(sample.pressure_pa)) return Result::kInside;
  const bool has_temperature = std::isfinite(sample.temperature_c);
  if (has_temperature) temperature_c_ = sample.temperature_c;
  const double raw_pa = sample.pressure_pa;
  if (raw_pa != last_raw_pa_) {
    last_raw_pa_ = raw_pa;
    last_compensated_pa_ = compensated_pa(compensation_, range_, raw_pa, temperature_c_);
  }
  sample.pressure_pa = last_compensated_pa_;
  if (std::isnan(sample.variance_pa2)) sample.variance_pa2 = variance_pa2_;
  if (!has_temperature && uses_temperature_) return Result::kNoTemperature;
  return range_.holds(raw_pa, temperature_c_) ? Result::kInside : Result::kOutside;
}

}  // namespace isobar
