// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "core/registration/map_height.hpp"

namespace isobar::test::test_map_height {

namespace {

constexpr std::int64_t kStartNs = 1'000'000'000;
constexpr double kScanS = 0.1;

// A robot that drives at `speed_m_s`; its scans hold it at `z`, and its altimeter reads `altimeter`, functions of time.
struct Drive {
  double speed_m_s = 0.5;
  double stays =
      0.1;  // share of a correction that stays, because scans are laid onto ground mapped before it
  double tilt_rad = 0.0;  // of the map, 1 sigma
  HeightSource source = HeightSource::kDifferential;
  std::function<double(double)> z = [](double) { return 0.0; };
  std::function<double(double)> altimeter = [](double) { return 0.0; };

  MapHeight height{};
  PriorHistory history{};
  std::uint32_t readings = 0;
  double t = 0.0;
  double corrected_m = 0.0;

  Drive() { height.restart(); }

  void go(double seconds) {
    for (const double end = t + seconds; t < end; t += kScanS) {
      Prior prior;
      for (int i = 0; i < 4; ++i) {
        const double at = t + 0.25 * kScanS * i;
        prior.stamp_ns = kStartNs + static_cast<std::int64_t>(at * 1e9);
        prior.height_source = source;
        prior.velocity_valid = true;
        prior.v_base_m_s.x() = speed_m_s;
        prior.altimeter_m = altimeter(at);
        prior.altimeter_variance_m2 = 0.0009;
        prior.altimeter_count = ++readings;
        history.add(prior);
      }
      height.advance_to(prior.stamp_ns, history);
      corrected_m += stays * height.update(z(t) + corrected_m, speed_m_s * kScanS, 1e-6, true,
                                           {tilt_rad * tilt_rad, tilt_rad * tilt_rad});
    }
  }
};

}  // namespace

TEST_CASE("a barometer that drifts moves the altimeter's bias and not the height") {
  for (const double rate_m_s : {0.02, 0.085, 0.17, 0.42}) {  // 0.25, 1, 2 and 5 Pa/s
    CAPTURE(rate_m_s);
    Drive drive;
    drive.go(20.0);
    drive.altimeter = [&](double t) { return rate_m_s * std::max(0.0, t - 20.0); };
    drive.go(70.0);
    // Until the bias follows the drift, a part of it is taken for an error of the map.
    CHECK(std::abs(drive.corrected_m) < 0.1);
    CHECK(drive.height.bias_m() == doctest::Approx(rate_m_s * 70.0).epsilon(0.15));
    CHECK(drive.height.altimeter_faulty());
  }
}

TEST_CASE("doors and zones move the altimeter's bias and not the height, and are no fault") {
  Drive drive;
  drive.go(20.0);
  // Pulses of 8 Pa of 1.5 s every 15 s, in a zone of 4 Pa from half a minute on.
  drive.altimeter = [](double t) {
    return (std::fmod(t, 15.0) < 1.5 ? 0.68 : 0.0) + (t > 50.0 ? 0.34 : 0.0);
  };
  drive.go(120.0);
  CHECK(std::abs(drive.corrected_m) < 0.02);
  CHECK_FALSE(drive.height.altimeter_faulty());
}

TEST_CASE("over kilometres the altimeter keeps the map's height") {
  Drive drive;
  drive.speed_m_s = 5.0;
  drive.stays = 0.5;  // at speed new ground comes sooner
  // The scans gain 1 m in 2 km, ten times what the random walk expects.
  drive.z = [](double t) { return t * 5.0 * 5e-4; };
  drive.go(400.0);
  CHECK(drive.corrected_m < -0.4);
  CHECK(drive.corrected_m > -1.05);
}

TEST_CASE("the variance of the height grows with the way, and not while the robot stands") {
  Drive drive;
  drive.go(100.0);
  const double after_50_m = drive.height.variance_m2();
  CHECK(after_50_m > 1e-4);
  drive.speed_m_s = 0.0;
  drive.go(100.0);
  CHECK(drive.height.variance_m2() <= after_50_m);
}

TEST_CASE("a map that may be tilted is unsure of the height ahead from the first metres") {
  Drive level;
  level.go(10.0);
  Drive tilted;
  tilted.tilt_rad = 0.01;
  tilted.go(10.0);
  CHECK(std::sqrt(level.height.variance_m2()) < 0.025);
  CHECK(std::sqrt(tilted.height.variance_m2()) > 0.03);
}

TEST_CASE("without a base station the weather is the altimeter's") {
  Drive drive;
  drive.source = HeightSource::kSingleBarometer;
  drive.altimeter = [](double t) { return 0.003 * t; };
  drive.go(300.0);
  CHECK(std::abs(drive.corrected_m) < 0.1);
}

}  // namespace isobar::test::test_map_height
