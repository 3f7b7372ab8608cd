// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

constexpr double kMaxPressurePa = 200e3;
constexpr double kMinTemperatureC = -100.0;
constexpr double kMaxTemperatureC = 200.0;

void add_polynomial(CompensationConfig& compensation, SectionBuilder& section) {
  section.number("pressure_centre_pa", &compensation.pressure_centre_pa, "Pa", 0.0, kMaxPressurePa,
                 "Pressure centre: u = (p - pressure_centre_pa) / pressure_scale_pa. `isobar calibrate` sets "
                 "it to the data.");
  section.number("pressure_scale_pa", &compensation.pressure_scale_pa, "Pa", 1e-3, kMaxPressurePa,
                 "Pressure scale: u = (p - pressure_centre_pa) / pressure_scale_pa. Keeps the powers of u "
                 "near 1.");
  section.number("temperature_centre_c", &compensation.temperature_centre_c, "degC", kMinTemperatureC,
                 kMaxTemperatureC,
                 "Temperature centre: v = (t - temperature_centre_c) / temperature_scale_c. `isobar "
                 "calibrate` sets it to the data.");
  section.number("temperature_scale_c", &compensation.temperature_scale_c, "K", 1e-3, kMaxTemperatureC,
                 "Temperature scale: v = (t - temperature_centre_c) / temperature_scale_c. Keeps the powers "
                 "of v near 1.");
  section.number("coefficients", &compensation.coefficients, "Pa", -1e6, 1e6,
                 "Coefficients c_00 c_01 c_02 c_03 c_10 ... c_33, sixteen numbers; the first index is the "
                 "power of u, the second that of v. Empty where model is \"none\".");
}

void add_calibrated_range(CalibratedRange& range, SectionBuilder& section) {
  section.number("lowest_pressure_pa", &range.lowest_pa, "Pa", 0.0, kMaxPressurePa,
                 "Lower end of the calibrated pressures. Outside the calibrated range the correction of the "
                 "nearest calibrated point applies and the sample is counted.");
  section.number("highest_pressure_pa", &range.highest_pa, "Pa", 0.0, kMaxPressurePa,
                 "Upper end of the calibrated pressures.");
  section.number("lowest_temperature_c", &range.lowest_c, "degC", kMinTemperatureC, kMaxTemperatureC,
                 "Lower end of the calibrated temperatures.");
  section.number("highest_temperature_c", &range.highest_c, "degC", kMinTemperatureC, kMaxTemperatureC,
                 "Upper end of the calibrated temperatures.");
}

}  // namespace

void add_compensation_settings(const std::string& section, UsedBy used_by, CompensationConfig& compensation,
                               std::vector<Setting>& settings) {
  SectionBuilder s(section, used_by, settings);
  s.choice("model", &compensation.model, compensation_choices(),
           "Calibration model: which coefficients are not zero. none: samples are not corrected.");
  add_polynomial(compensation, s);
  add_calibrated_range(compensation.range, s);
  s.number("sigma_pa", &compensation.sigma_pa, "Pa", 0.0, 1'000.0,
           "White noise of one compensated sample, 1 sigma; used where the sender gives no variance. "
           "0: not known.");
}

}  // namespace isobar
