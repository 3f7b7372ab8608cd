// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/samples.hpp"

#include <cmath>
#include <limits>

#include "core/plausibility.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::dds {
namespace {

/// Copies the candidate to `sample` if its stamp and values are plausible.
template <class Sample>
const char* hand_over(const HeaderMessage& header, Sample& candidate, Sample& sample) noexcept {
  candidate.stamp_ns = to_stamp_ns(header.stamp);
  const char* broken = implausible_stamp(candidate.stamp_ns);
  broken = broken != nullptr ? broken : implausibility(candidate);
  if (broken == nullptr) {
    sample = candidate;
  }
  return broken;
}

Eigen::Vector3d to_vector(const geometry_msgs_msg_dds__Vector3_& message) noexcept {
  return {message.x, message.y, message.z};
}

/// A variance of a covariance that is stated; one that is no number stays an implausible one, for the count.
double stated(double variance) noexcept {
  return std::isnan(variance) ? std::numeric_limits<double>::infinity() : variance;
}

const char* take_twist(const HeaderMessage& header,
                       const geometry_msgs_msg_dds__TwistWithCovariance_& message,
                       WheelSample& sample) noexcept {
  // Diagonal of the covariance, row-major, of x, y, z and the turns about x, y, z.
  constexpr std::size_t kX = 0;
  constexpr std::size_t kY = 7;
  constexpr std::size_t kYaw = 35;
  WheelSample candidate;
  candidate.vx_m_s = message.twist.linear.x;
  candidate.vy_m_s = message.twist.linear.y;
  candidate.wz_rad_s = message.twist.angular.z;
  const auto& covariance = message.covariance;
  // Not stated: -1 in the first place, as in REP-145, or zeros (sensor_msgs), also of a single direction.
  if (covariance[kX] != -1.0) {
    if (covariance[kX] != 0.0) candidate.vx_variance_m2_s2 = stated(covariance[kX]);
    if (covariance[kY] != 0.0) candidate.vy_variance_m2_s2 = stated(covariance[kY]);
    if (covariance[kYaw] != 0.0) candidate.wz_variance_rad2_s2 = stated(covariance[kYaw]);
  }
  return hand_over(header, candidate, sample);
}

}  // namespace

const char* to_sample(const PressureMessage& message, PressureSample& sample) noexcept {
  PressureSample candidate;
  candidate.pressure_pa = message.fluid_pressure;
  candidate.temperature_c = std::numeric_limits<double>::quiet_NaN();
  const bool variance_known = message.variance > 0.0 && std::isfinite(message.variance);
  candidate.variance_pa2 = variance_known ? message.variance : std::numeric_limits<double>::quiet_NaN();
  return hand_over(message.header, candidate, sample);
}

const char* to_sample(const ImuMessage& message, ImuSample& sample) noexcept {
  ImuSample candidate;
  candidate.gyro_rad_s = to_vector(message.angular_velocity);
  candidate.accel_m_s2 = to_vector(message.linear_acceleration);
  const auto& q = message.orientation;
  candidate.has_attitude = message.orientation_covariance[0] != -1.0;
  if (candidate.has_attitude) {
    candidate.q_world_imu = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  }
  const char* broken = hand_over(message.header, candidate, sample);
  if (broken == nullptr) {
    sample.q_world_imu.normalize();
  }
  return broken;
}

const char* to_sample(const OdometryMessage& message, WheelSample& sample) noexcept {
  return take_twist(message.header, message.twist, sample);
}

const char* to_sample(const TwistMessage& message, WheelSample& sample) noexcept {
  return take_twist(message.header, message.twist, sample);
}

void fill_pressure(const PressureSample& sample, const std::string& frame,
                   PressureMessage& message) noexcept {
  fill_header(sample.stamp_ns, frame, message.header);
  message.fluid_pressure = sample.pressure_pa;
  message.variance = sample.variance_pa2 > 0.0 ? sample.variance_pa2 : 0.0;  // NaN compares false
}

const char* to_sample(const TemperatureMessage& message, TemperatureSample& sample) noexcept {
  const std::int64_t stamp_ns = to_stamp_ns(message.header.stamp);
  if (const char* broken = implausible_stamp(stamp_ns); broken != nullptr) {
    return broken;
  }
  if (!kPlausibleTemperatureC.holds(message.temperature)) {
    return "temperature must lie within -60 … 100 degrees C";
  }
  sample = {stamp_ns, message.temperature};
  return nullptr;
}

void fill_temperature(const PressureSample& sample, const std::string& frame,
                      TemperatureMessage& message) noexcept {
  fill_header(sample.stamp_ns, frame, message.header);
  message.temperature = sample.temperature_c;
  message.variance = 0.0;
}

}  // namespace isobar::dds
