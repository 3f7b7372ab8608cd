// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include "core/registration/map_height.hpp"

namespace isobar::test {

/// A robot that drives at `speed_m_s`; its scans hold it at `z`, and its altimeter reads `altimeter`, functions of time.
struct HeightDrive {
  static constexpr std::int64_t kStartNs = 1'000'000'000;
  static constexpr double kScanS = 0.1;
  static inline const MapHeightConfig kConfig;

  double speed_m_s = 0.5;
  double airflow_s2_m = 0.0;  // of the altimeter's error, beside `altimeter`
  bool wheels = true;
  double stays =
      0.1;  // share of a correction that stays, because scans are laid onto ground mapped before it
  double tilt_rad = 0.0;      // of the map, 1 sigma
  double turbulence_m = 0.0;  // of the altimeter, 1 sigma, over 3 s
  HeightSource source = HeightSource::kDifferential;
  std::function<double(double)> z = [](double) { return 0.0; };
  std::function<double(double)> altimeter = [](double) { return 0.0; };

  MapHeight height{kConfig};
  PriorHistory history{};
  std::uint32_t readings = 0;
  double t = 0.0;
  double corrected_m = 0.0;
  double unrest_m = 0.0;
  std::mt19937 random{1};

  HeightDrive() { height.restart(); }

  double air(double at) {
    constexpr double kTurbulenceS = 3.0;
    const double keep = std::exp(-0.25 * kScanS / kTurbulenceS);
    std::normal_distribution<double> normal(0.0, 1.0);
    unrest_m = keep * unrest_m + turbulence_m * std::sqrt(1.0 - keep * keep) * normal(random);
    return altimeter(at) + unrest_m + airflow_s2_m * speed_m_s * speed_m_s;
  }

  void go(double seconds) {
    for (const double end = t + seconds; t < end; t += kScanS) {
      Prior prior;
      for (int i = 0; i < 4; ++i) {
        const double at = t + 0.25 * kScanS * i;
        prior.stamp_ns = kStartNs + static_cast<std::int64_t>(at * 1e9);
        prior.height_source = source;
        prior.velocity_valid = wheels;
        prior.v_base_m_s.x() = wheels ? speed_m_s : 0.0;
        prior.altimeter_m = air(at);
        prior.altimeter_variance_m2 = 0.0009;
        prior.altimeter_count = ++readings;
        history.add(prior);
      }
      height.advance_to(prior.stamp_ns, history);
      corrected_m += stays * height.update(z(t) + corrected_m, speed_m_s * kScanS, 1e-6, true,
                                           {tilt_rad * tilt_rad, tilt_rad * tilt_rad});
    }
  }

  /// Accelerates by 1 m/s^2, or brakes, to `speed`.
  void change_speed(double speed) {
    const double step = speed > speed_m_s ? 0.1 : -0.1;
    for (int left = static_cast<int>(std::lround(std::abs(speed - speed_m_s) / 0.1)); left > 0; --left) {
      speed_m_s += step;
      go(0.5 * kScanS);
    }
    speed_m_s = speed;
  }

  /// Starts and stops for `seconds`.
  void stop_and_go(double speed, double seconds) {
    for (const double end = t + seconds; t < end;) {
      change_speed(speed);
      go(12.0);
      change_speed(0.0);
      go(6.0);
    }
  }
};

}  // namespace isobar::test
