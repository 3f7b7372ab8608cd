// SPDX-License-Identifier: BSD-3-Clause
#include "tools/inertial_heights.hpp"

#include "core/prior/inertial_altimeter.hpp"
#include "core/prior/prior_estimator.hpp"

namespace isobar::tools {

HeightSeries inertial_heights(std::span<const ImuSample> imu, const HeightSeries& raw, double sigma_m,
                              HeightSource source) {
  const PriorConfig config;
  PriorEstimator attitude(config);
  InertialAltimeter altimeter(config.height);
  HeightSeries series;
  std::size_t next = 0;
  for (const ImuSample& sample : imu) {
    Prior prior;
    if (!attitude.add_imu(sample, prior) || !prior.attitude_valid) continue;
    const double up_m_s2 = (prior.T_odom_base.linear() * sample.accel_m_s2).z() - kGravity;
    if (altimeter.add_acceleration(sample.stamp_ns, up_m_s2) != InertialAltimeter::Status::kUsed) continue;
    bool used = false;
    for (; next < raw.stamps_ns.size() && raw.stamps_ns[next] <= sample.stamp_ns; ++next) {
      AltimeterReading reading;
      reading.stamp_ns = raw.stamps_ns[next];
      reading.height_m = raw.heights_m[next];
      reading.noise_variance_m2 = sigma_m * sigma_m;
      reading.source = source;
      used = altimeter.add_height(reading) == InertialAltimeter::Status::kUsed || used;
    }
    if (!used) continue;
    series.stamps_ns.push_back(sample.stamp_ns);
    series.heights_m.push_back(altimeter.height_m());
  }
  return series;
}

}  // namespace isobar::tools
