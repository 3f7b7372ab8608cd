// SPDX-License-Identifier: BSD-3-Clause
#include "run/recording/sample_csv.hpp"

#include <cmath>
#include <limits>

#include "core/plausibility.hpp"
#include "run/text/number_text.hpp"

namespace isobar::recording {
namespace {

constexpr const char* kNoStamp = "t_ns must be a whole number of nanoseconds";
constexpr const char* kNoNumber = "must be a finite number";
/// Largest deviation of a quaternion's norm from 1 that is not normalised, so that written samples keep their
/// bits.
constexpr double kExactNorm = 1e-12;

const char* parse_stamp(const text::CsvReader& csv, std::int64_t& stamp_ns, std::string& value) {
  if (!text::parse_number(csv.field(0), stamp_ns)) {
    value = csv.field(0);
    return kNoStamp;
  }
  const char* rule = implausible_stamp(stamp_ns);
  if (rule != nullptr) {
    value = csv.field(0);
  }
  return rule;
}

const char* parse_column(const text::CsvReader& csv, std::size_t column, double& number, std::string& value) {
  if (text::parse_number(csv.field(column), number) && std::isfinite(number)) {
    return nullptr;
  }
  value = csv.field(column);
  return kNoNumber;
}

/// The four attitude columns. An attitude that is not available yet (NaN, zeros) does not make the sample
/// invalid: rates and forces are used.
void parse_attitude(const text::CsvReader& csv, ImuSample& sample) {
  constexpr std::size_t kFirst = 7;
  double q[4] = {};  // NOLINT(modernize-avoid-c-arrays)
  sample.has_attitude = true;
  for (std::size_t i = 0; i < 4; ++i) {
    sample.has_attitude = sample.has_attitude && csv.has(kFirst + i) &&
                          text::parse_number(csv.field(kFirst + i), q[i]) && std::isfinite(q[i]);
  }
  sample.q_world_imu = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  const double norm = sample.q_world_imu.norm();
  if (!sample.has_attitude || !kPlausibleQuaternionNorm.holds(norm)) {
    sample.has_attitude = false;
    sample.q_world_imu.setIdentity();
  } else if (std::abs(norm - 1.0) > kExactNorm) {
    sample.q_world_imu.normalize();
  }
}

/// The columns that only live recordings have. Unusable fields leave the defaults.
void parse_origin(const text::CsvReader& csv, PressureSample& sample) {
  constexpr std::size_t kVariance = 3;
  constexpr std::size_t kStation = 4;
  constexpr std::int64_t kMostStations = 2;
  double variance_pa2 = 0.0;
  if (csv.has(kVariance) && text::parse_number(csv.field(kVariance), variance_pa2) &&
      std::isfinite(variance_pa2) && variance_pa2 > 0.0) {
    sample.variance_pa2 = variance_pa2;
  }
  std::int64_t station = 0;
  if (csv.has(kStation) && text::parse_number(csv.field(kStation), station) && station >= 0 &&
      station < kMostStations) {
    sample.station = static_cast<std::uint8_t>(station);
  }
}

/// The columns of a sender that states its noise. An unusable field means that it did not.
void parse_variances(const text::CsvReader& csv, WheelSample& sample) {
  std::size_t column = 4;
  for (double* stated : {&sample.vx_variance_m2_s2, &sample.vy_variance_m2_s2, &sample.wz_variance_rad2_s2}) {
    double variance = 0.0;
    const bool is_stated = csv.has(column) && text::parse_number(csv.field(column), variance);
    if (is_stated) *stated = variance;
    ++column;
  }
}

}  // namespace

text::CsvReader open_imu_csv(const std::filesystem::path& file) {
  return {text::TextLines(file),
          {"t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2"},
          {"qw", "qx", "qy", "qz"}};
}

text::CsvReader open_pressure_csv(const std::filesystem::path& file) {
  return {text::TextLines(file), {"t_ns", "pressure_pa", "temperature_c"}, {"variance_pa2", "station"}};
}

text::CsvReader open_wheel_csv(const std::filesystem::path& file) {
  return {text::TextLines(file),
          {"t_ns", "vx_m_s", "vy_m_s", "wz_rad_s"},
          {"vx_variance_m2_s2", "vy_variance_m2_s2", "wz_variance_rad2_s2"}};
}

const char* parse_row(const text::CsvReader& csv, ImuSample& sample, std::string& value) {
  if (const char* rule = parse_stamp(csv, sample.stamp_ns, value); rule != nullptr) {
    return rule;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    double& number = i < 3 ? sample.gyro_rad_s[static_cast<Eigen::Index>(i)]
                           : sample.accel_m_s2[static_cast<Eigen::Index>(i - 3)];
    if (const char* rule = parse_column(csv, 1 + i, number, value); rule != nullptr) {
      return rule;
    }
  }
  parse_attitude(csv, sample);
  return implausibility(sample);
}

const char* parse_row(const text::CsvReader& csv, PressureSample& sample, std::string& value) {
  if (const char* rule = parse_stamp(csv, sample.stamp_ns, value); rule != nullptr) {
    return rule;
  }
  if (const char* rule = parse_column(csv, 1, sample.pressure_pa, value); rule != nullptr) {
    return rule;
  }
  if (csv.field(2).empty()) {
    sample.temperature_c = std::numeric_limits<double>::quiet_NaN();
  } else if (!text::parse_number(csv.field(2), sample.temperature_c)) {
    value = csv.field(2);
    return kNoNumber;
  }
  parse_origin(csv, sample);
  const char* rule = implausibility(sample);
  if (rule != nullptr) {
    value = kPlausiblePressurePa.holds(sample.pressure_pa) ? csv.field(2) : csv.field(1);
  }
  return rule;
}

const char* parse_row(const text::CsvReader& csv, WheelSample& sample, std::string& value) {
  if (const char* rule = parse_stamp(csv, sample.stamp_ns, value); rule != nullptr) {
    return rule;
  }
  std::size_t column = 1;
  for (double* number : {&sample.vx_m_s, &sample.vy_m_s, &sample.wz_rad_s}) {
    if (const char* rule = parse_column(csv, column++, *number, value); rule != nullptr) {
      return rule;
    }
  }
  parse_variances(csv, sample);
  return implausibility(sample);
}

template <typename Sample>
bool next_sample(text::CsvReader& csv, Sample& sample, Tally& malformed, Tally& implausible) {
  std::string value;
  for (;;) {
    const text::CsvReader::Row row = csv.next();
    if (row == text::CsvReader::Row::kEnd) {
      return false;
    }
    if (row == text::CsvReader::Row::kBad) {
      malformed.add([&csv] { return csv.bad_row_message(); });
      continue;
    }
    sample = Sample{};
    const char* rule = parse_row(csv, sample, value);
    if (rule == nullptr) {
      return true;
    }
    Tally& tally = rule == kNoStamp || rule == kNoNumber ? malformed : implausible;
    tally.add([&] {
      return csv.lines().place() + rule + (value.empty() ? std::string() : " (is '" + value + "')");
    });
    value.clear();
  }
}

template bool next_sample(text::CsvReader&, ImuSample&, Tally&, Tally&);
template bool next_sample(text::CsvReader&, PressureSample&, Tally&, Tally&);
template bool next_sample(text::CsvReader&, WheelSample&, Tally&, Tally&);

}  // namespace isobar::recording
