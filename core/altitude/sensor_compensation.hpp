// SPDX-License-Identifier: BSD-3-Clause
// A calibrated sensor: what `isobar calibrate` found, applied to its samples.
#pragma once

#include <limits>
#include <vector>

#include "core/altitude/compensation.hpp"
#include "core/altitude/compensation_model.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Where a calibration has seen the sensor.
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

/// The correction p_cal - p_raw of the nearest place of the calibrated range, added to the raw pressure.
/// Inside of it that is eq. (1); outside a polynomial of third order soon errs by more than the sensor ever
/// did, while the held correction leaves differences of pressure, and so of height, as the sensor measured
/// them.
double compensated_pa(const Compensation& compensation, const CalibratedRange& range, double pressure_pa,
                      double temperature_c);

/// Result of a calibration. [barometer.compensation] has the same keys.
struct CompensationConfig {
  CompensationModel model = CompensationModel::kNone;  ///< kNone: the samples stay as they are

  /// Centre and scale of u = (p - centre) / scale and v = (t - centre) / scale; Pa and degC.
  double pressure_centre_pa = 100'000.0;
  double pressure_scale_pa = 1'000.0;
  double temperature_centre_c = 20.0;
  double temperature_scale_c = 10.0;

  /// c_ij [Pa] of p_cal = sum of c_ij u^i v^j: c_00 c_01 c_02 c_03 c_10 …, sixteen numbers. Empty with kNone.
  std::vector<double> coefficients;

  CalibratedRange range;

  /// White noise of one compensated sample, 1 sigma [Pa]; 0: not known.
  double sigma_pa = 0.0;
};

/// Which rule a calibration breaks, as a text that never dies; nullptr when it can be used. `key`, if given,
/// then is the name of the field as the configuration spells it.
const char* broken_compensation_rule(const CompensationConfig& config, const char** key = nullptr);

/// Applies a calibration to one sensor's samples, in their order. No allocation after construction.
class SensorCompensation {
 public:
  explicit SensorCompensation(const CompensationConfig& config = {});

  enum class Result {
    kInside,         ///< compensated within the calibrated range, or there is no calibration
    kOutside,        ///< compensated with the correction of the range's nearest place
    kNoTemperature,  ///< compensated with the last temperature that was known, else the range's middle
  };

  /// Replaces the pressure by the compensated one, and a variance that the sender does not know by the
  /// calibration's. A pressure that has not changed by one bit gives the result before, whatever the
  /// temperature did: a stuck sensor must still be seen as stuck.
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
