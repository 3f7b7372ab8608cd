// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

namespace isobar {

void add_compensation_settings(const std::string& section, CompensationConfig& compensation,
                               std::vector<Setting>& settings) {
  settings.push_back(
      {.key = section + ".model",
       .target = &compensation.model,
       .doc = "none: samples stay as they are. The others say which coefficients are not zero.",
       .choices = compensation_choices()});
  const auto add = [&](const char* name, Setting::Target target, const char* unit, double lowest,
                       double highest, const char* doc) {
    settings.push_back({section + "." + name, target, unit, lowest, highest, doc});
  };
  constexpr double kMostPa = 200e3;
  add("pressure_centre_pa", &compensation.pressure_centre_pa, "Pa", 0.0, kMostPa, "Pressure where u is 0.");
  add("pressure_scale_pa", &compensation.pressure_scale_pa, "Pa", 1e-3, kMostPa,
      "And that much further u is 1.");
  add("temperature_centre_c", &compensation.temperature_centre_c, "degC", -100.0, 200.0,
      "Temperature where v is 0.");
  add("temperature_scale_c", &compensation.temperature_scale_c, "K", 1e-3, 200.0,
      "And that much warmer v is 1.");
  add("coefficients", &compensation.coefficients, "Pa", -1e6, 1e6,
      "c_00 c_01 c_02 c_03 c_10 ... c_33, sixteen; the first index is the power of u, the second of v.");
  add("lowest_pressure_pa", &compensation.range.lowest_pa, "Pa", 0.0, kMostPa,
      "Where it was calibrated: outside, the correction of the nearest place is used and the sample is "
      "counted.");
  add("highest_pressure_pa", &compensation.range.highest_pa, "Pa", 0.0, kMostPa, "Upper end of that.");
  add("lowest_temperature_c", &compensation.range.lowest_c, "degC", -100.0, 200.0,
      "The same for the temperature.");
  add("highest_temperature_c", &compensation.range.highest_c, "degC", -100.0, 200.0, "Upper end of that.");
  add("sigma_pa", &compensation.sigma_pa, "Pa", 0.0, 1'000.0,
      "White noise of one compensated sample, 1 sigma, where its sender does not know it; 0: not known.");
}

}  // namespace isobar
