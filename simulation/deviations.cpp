// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/deviations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace isobar::simulation {

namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

std::string ramp_text(const Ramp& ramp) {
  std::string text = number(ramp.rate_pa_s);
  if (ramp.start_s == 0.0 && std::isinf(ramp.duration_s)) return text;
  text += ":" + number(ramp.start_s);
  return std::isinf(ramp.duration_s) ? text : text + ":" + number(ramp.duration_s);
}

std::string range_text(const PressureRange& range) {
  return number(range.low_pa) + ":" + number(range.high_pa);
}

void add_barometer(std::vector<std::string>& options, const std::string& name,
                   const BarometerDeviation& deviation) {
  if (deviation.drift.rate_pa_s != 0.0) {
    options.push_back("drift " + name + ":" + ramp_text(deviation.drift));
  }
  if (deviation.thermometer_offset_k != 0.0) {
    options.push_back("thermometer " + name + ":" + number(deviation.thermometer_offset_k));
  }
}

}  // namespace

std::vector<std::string> Deviations::options() const {
  std::vector<std::string> options;
  if (mount_error_deg != 0.0) options.push_back("mount-error " + number(mount_error_deg));
  add_barometer(options, "robot", robot);
  add_barometer(options, "base", base);
  if (base_rate_hz != kFullBaseRateHz) options.push_back("base-rate " + number(base_rate_hz));
  if (common_ramp.rate_pa_s != 0.0) options.push_back("common-ramp " + ramp_text(common_ramp));
  if (common_gust.amplitude_pa != 0.0) {
    options.push_back("common-gust " + number(common_gust.amplitude_pa) + ":" +
                      number(common_gust.frequency_hz));
  }
  if (base_silent) {
    options.push_back("base-silent " + number(base_silent->start_s) + ":" +
                      number(base_silent->end_s - base_silent->start_s));
  }
  if (airflow) options.push_back("airflow " + number(*airflow));
  if (zones) options.push_back("zones " + range_text(*zones));
  if (pulses) options.push_back("door-pulses " + range_text(*pulses));
  if (start_at_s != 0.0) options.push_back("start-at " + number(start_at_s));
  if (without_imu) options.emplace_back("without imu");
  if (without_wheels) options.emplace_back("without wheels");
  if (without_base) options.emplace_back("without base");
  if (without_barometer) options.emplace_back("without barometer");
  return options;
}

std::string Deviations::suffix() const {
  std::string text;
  for (const std::string& option : options()) text += "-" + option;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == ':'; }, '-');
  return text;
}

}  // namespace isobar::simulation
