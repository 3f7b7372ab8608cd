// SPDX-License-Identifier: BSD-3-Clause
// Compensation of a sensor's samples with the result of `isobar calibrate`.
#pragma once

#include <limits>
#include <vector>

#include "core/altitude/compensation.hpp"
#include "core/altitude/compensation_model.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Pressures and temperatures that the calibration data cover.
struct CalibratedRange {
  double lowest_pa = 0.0;
  double highest_pa = 0.0;
  double lowest_c = 0.0;
  double highest_c = 0.0;

  [[nodiscard]] bool holds(double pressure_pa, double temperature_c) const {
    return pressure_pa >= lowest_pa && pressure_pa <= highest_pa && temperature_c >= lowest_c &&
           temperature_c <= highest_c;
  }
};

/// Raw pressure plus the correction p_cal - p_raw at the nearest point of the calibrated range [Pa]. Inside
/// the range that is eq. (1). Outside, a cubic polynomial soon errs by more than the raw sensor; a constant
/// correction keeps differences of pressure, and so of height, as measured.
double compensated_pa(const Compensation& compensation, const CalibratedRange& range, double pressure_pa,
                      double temperature_c);

/// Result of a calibration. [barometer.compensation] has the same keys.
struct CompensationConfig {
  CompensationModel model = CompensationModel::kNone;  ///< kNone: samples unchanged

  /// Centre and scale of u = (p - centre) / scale and v = (t - centre) / scale; Pa and degC.
  double pressure_centre_pa = 100'000.0;
  double pressure_scale_pa = 1'000.0;
  double temperature_centre_c = 20.0;
  double temperature_scale_c = 10.0;

  /// c_ij [Pa] of p_cal = sum of c_ij u^i v^j, row by row: c_00 c_01 c_02 c_03 c_10 …, sixteen numbers. Empty
  /// with kNone.
  std::vector<double> coefficients;

  CalibratedRange range;

  /// White noise of one compensated sample, 1 sigma [Pa]; 0: unknown.
  double sigma_pa = 0.0;
};

/// Text of the rule that a calibration breaks (static storage); nullptr if it is valid. `key`, if given, is
/// set to the field's name in the configuration when a rule is broken.
const char* broken_compensation_rule(const CompensationConfig& config, const char** key = nullptr);

/// Applies a calibration to one sensor's samples, in order of time. No allocation after construction.
class SensorCompensation {
 public:
  explicit SensorCompensation(const CompensationConfig& config = {});

  enum class Result {
    kInside,         ///< compensated within the calibrated range, or no calibration
    kOutside,        ///< compensated with the correction at the nearest point of the range
    kNoTemperature,  ///< compensated with the last known temperature, initially the middle of the range
  };

  /// Replaces the pressure by the compensated one, and an unknown variance (NaN) by the calibration's. A
  /// bit-identical raw pressure gives the previous result whatever the temperature: a stuck sensor must stay
  /// detectable as stuck.
  Result apply(PressureSample& sample);

 private:
  bool active_;
  bool uses_temperature_;
  Compensation compensation_;
  CalibratedRange range_;
  double variance_pa2_;
  double temperature_c_;
  double last_raw_pa_ = std::numeric_limits<double>::quiet_NaN();
  double last_compensated_pa_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace isobar
