// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/vn100/text_measurement.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

namespace isobar::vn100 {

namespace {

constexpr std::size_t kMostValues = 17;
constexpr int kNone = -1;

/// Where the values of use stand in an output, by their number behind the header; kNone: it has none.
struct TextForm {
  std::string_view header;
  std::size_t values = 0;
  int accel = kNone;  ///< specific force in the sensor's frame [m/s^2]
  int gyro = kNone;   ///< [rad/s]
  int yaw_pitch_roll = kNone;
  int quaternion = kNone;
  int temperature = kNone;  ///< [deg C], pressure [kPa] behind it
  int increments = kNone;   ///< interval [s], turn [deg], velocity [m/s]
};

// VNYBA and VNYIA: gravity is taken out of their accelerations. VNRAW: counts of the converter. VNISL, VNISE: of the
// VN-200 and VN-300. VNQTA … VNQAR, VNYCM and VNCMV: of older firmware.
constexpr std::array<TextForm, 25> kTextForms{{
    {.header = "VNYPR", .values = 3},
    {.header = "VNQTN", .values = 4},
    {.header = "VNQTM", .values = 7},
    {.header = "VNQTA", .values = 7, .accel = 4, .quaternion = 0},
    {.header = "VNQTR", .values = 7, .gyro = 4, .quaternion = 0},
    {.header = "VNQMA", .values = 10, .accel = 7, .quaternion = 0},
    {.header = "VNQAR", .values = 10, .accel = 4, .gyro = 7, .quaternion = 0},
    {.header = "VNQMR", .values = 13, .accel = 7, .gyro = 10, .quaternion = 0},
    {.header = "VNDCM", .values = 9},
    {.header = "VNMAG", .values = 3},
    {.header = "VNACC", .values = 3, .accel = 0},
    {.header = "VNGYR", .values = 3, .gyro = 0},
    {.header = "VNMAR", .values = 9, .accel = 3, .gyro = 6},
    {.header = "VNYMR", .values = 12, .accel = 6, .gyro = 9, .yaw_pitch_roll = 0},
    {.header = "VNYCM", .values = 13, .accel = 6, .gyro = 9, .yaw_pitch_roll = 0},
    {.header = "VNYBA", .values = 9, .gyro = 6, .yaw_pitch_roll = 0},
    {.header = "VNYIA", .values = 9, .gyro = 6, .yaw_pitch_roll = 0},
    {.header = "VNIMU", .values = 11, .accel = 3, .gyro = 6, .temperature = 9},
    {.header = "VNCMV", .values = 10, .accel = 3, .gyro = 6},
    {.header = "VNRAW", .values = 10},
    {.header = "VNSTV", .values = 7},
    {.header = "VNDTV", .values = 7, .increments = 0},
    {.header = "VNINS", .values = 15},
    {.header = "VNISL", .values = 15, .accel = 9, .gyro = 12, .yaw_pitch_roll = 0},
    {.header = "VNISE", .values = 15, .accel = 9, .gyro = 12, .yaw_pitch_roll = 0},
}};

using Values = std::array<double, kMostValues>;

Eigen::Vector3d vector_of(const Values& values, int at) {
  const auto i = static_cast<std::size_t>(at);
  return {values.at(i), values.at(i + 1), values.at(i + 2)};
}

bool is_appended_status(std::string_view part) {
  return !part.empty() && std::string_view("STVI").find(part.front()) != std::string_view::npos;
}

/// A finite decimal number, with its sign: "+00.1234".
bool read_value(std::string_view part, double& value) {
  if (part.starts_with("+-")) return false;
  if (part.starts_with('+')) part.remove_prefix(1);
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  return error == std::errc{} && end == part.data() + part.size() && std::isfinite(value);
}

/// The values behind the header's comma up to '*'; false: not `count` finite ones.
bool read_values(std::string_view list, std::size_t count, Values& values) {
  std::size_t found = 0;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    const std::string_view part = list.substr(0, comma);
    list = comma == std::string_view::npos ? std::string_view{} : list.substr(comma + 1);
    if (found == count && is_appended_status(part)) continue;
    if (found == count || !read_value(part, values.at(found))) return false;
    ++found;
  }
  return found == count;
}

Inertial inertial_of(const TextForm& form, const Values& values) {
  constexpr double kRadPerDegree = std::numbers::pi / 180.0;
  Inertial inertial;
  if (form.accel != kNone) inertial.accel_m_s2 = vector_of(values, form.accel);
  if (form.gyro != kNone) inertial.gyro_rad_s = vector_of(values, form.gyro);
  if (form.increments == kNone) return inertial;
  const double interval_s = values[0];
  if (!(interval_s > 0.0)) return inertial;
  inertial.gyro_rad_s = vector_of(values, 1) * kRadPerDegree / interval_s;
  inertial.accel_m_s2 = vector_of(values, 4) / interval_s;
  return inertial;
}

}  // namespace

std::optional<TextMeasurement> read_text(std::string_view line) noexcept {
  constexpr std::size_t kHeader = 5;  // VN and three letters
  if (line.size() < kHeader + 2 || line.front() != '$' || line[kHeader + 1] != ',') return std::nullopt;
  const std::string_view header = line.substr(1, kHeader);
  const auto* form = std::find_if(kTextForms.begin(), kTextForms.end(),
                                  [header](const TextForm& known) { return known.header == header; });
  if (form == kTextForms.end()) return std::nullopt;
  const std::string_view list = line.substr(kHeader + 2, line.find('*') - kHeader - 2);
  Values values{};
  if (!read_values(list, form->values, values)) return std::nullopt;
  TextMeasurement result{form->header, {}};
  inertial_of(*form, values).put_into(result.measurement);
  InertialReading& reading = result.measurement.reading;
  if (form->temperature != kNone) {
    const auto at = static_cast<std::size_t>(form->temperature);
    set_pressure(values.at(at + 1), values.at(at), reading);
  }
  if (!reading.has_imu) return result;
  if (form->yaw_pitch_roll != kNone) {
    set_attitude(from_yaw_pitch_roll(vector_of(values, form->yaw_pitch_roll)), reading.imu);
  }
  if (form->quaternion != kNone) {
    set_attitude(Eigen::Quaterniond(values[3], values[0], values[1], values[2]), reading.imu);
  }
  return result;
}

}  // namespace isobar::vn100
