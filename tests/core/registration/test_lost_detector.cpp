// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include "core/geometry.hpp"
#include "core/registration/lost_detector.hpp"
#include "core/so3.hpp"

namespace isobar::test::test_lost_detector {

namespace {

constexpr std::int64_t kScanNs = 100'000'000;

/// Scans at 10 Hz of a robot that turns; the registered poses turn by an error of their own.
struct Drive {
  double yaw_deg_s = 0.0;
  Eigen::Vector3d error_deg_s = Eigen::Vector3d::Zero();  // of the registered poses, from 5 s on
  double tilt_sd_deg = 0.0;

  [[nodiscard]] LostEvidence at(int scan) const {
    const double time_s = 0.1 * scan;
    LostEvidence evidence;
    evidence.stamp_ns = 1 + scan * kScanNs;
    evidence.T_odom_base.linear() = rotation_about_z(time_s * yaw_deg_s * kRadPerDeg);
    const Eigen::Vector3d error = std::max(0.0, time_s - 5.0) * kRadPerDeg * error_deg_s;
    evidence.T_map_base.linear() = exp_so3(error).toRotationMatrix() * evidence.T_odom_base.linear();
    evidence.tilt_sd_rad = tilt_sd_deg * kRadPerDeg;
    return evidence;
  }
  /// Time of the first verdict [s]; negative: none within a minute.
  double lost_after_s(LostReason& reason, LostDetector& detector) const {
    for (int scan = 0; scan < 600; ++scan) {
      reason = detector.add(at(scan));
      if (reason != LostReason::kNone) return 0.1 * scan - 5.0;
    }
    return -1.0;
  }
};

}  // namespace

TEST_CASE("a turn that the gyro has not seen is noticed within a second, whatever its axis") {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(4.5, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 4.5)}) {
    LostDetector detector;
    LostReason reason = LostReason::kNone;
    const double after_s = Drive{.yaw_deg_s = 0.0, .error_deg_s = axis}.lost_after_s(reason, detector);
    CHECK(reason == LostReason::kTurn);
    CHECK(after_s > 0.0);
    CHECK(after_s < 1.0);
    // Back to before the contradiction.
    CHECK(detector.last_good().stamp_ns <= 1 + 50 * kScanNs);
  }
}

TEST_CASE("a slower turn is noticed by the longer window") {
  LostDetector detector;
  LostReason reason = LostReason::kNone;
  const double after_s =
      Drive{.yaw_deg_s = 0.0, .error_deg_s = {0.0, 0.0, 1.5}}.lost_after_s(reason, detector);
  CHECK(reason == LostReason::kTurn);
  CHECK(after_s > 2.0);
  CHECK(after_s < 4.0);
}

TEST_CASE("a tilt that grows too slowly for both windows is noticed by gravity") {
  LostDetector detector;
  LostReason reason = LostReason::kNone;
  const double after_s =
      Drive{.yaw_deg_s = 0.0, .error_deg_s = {0.5, 0.0, 0.0}}.lost_after_s(reason, detector);
  CHECK(reason == LostReason::kTilt);
  CHECK(after_s == doctest::Approx(24.1).epsilon(0.01));  // 12 degrees
}

TEST_CASE("what mounts, clocks and the attitude filter explain is no contradiction") {
  LostDetector detector;
  LostReason reason = LostReason::kNone;
  // 36 deg/s seen with 3 % of error.
  CHECK(Drive{.yaw_deg_s = 36.0, .error_deg_s = {0.0, 0.0, 1.0}}.lost_after_s(reason, detector) < 0.0);
  // Gravity is known to 1.5 degrees only, without wheels.
  detector.restart();
  CHECK(Drive{.yaw_deg_s = 0.0, .error_deg_s = {0.25, 0.0, 0.0}, .tilt_sd_deg = 1.5}.lost_after_s(
            reason, detector) < 0.0);
}

TEST_CASE("without wheels roll and pitch of dead reckoning are no witness of a turn, and yaw is") {
  const auto lost = [](const Eigen::Vector3d& error_deg_s, bool on_wheels) {
    LostDetector detector;
    const Drive drive{.yaw_deg_s = 0.0, .error_deg_s = error_deg_s};
    for (int scan = 0; scan < 80; ++scan) {
      LostEvidence evidence = drive.at(scan);
      evidence.on_wheels = on_wheels;
      if (detector.add(evidence) != LostReason::kNone) return true;
    }
    return false;
  };
  // Three seconds of an acceleration of 1.2 m/s^2: gravity seems to turn by 7 degrees.
  const Eigen::Vector3d pitch_deg_s(0.0, 2.3, 0.0);
  CHECK(!lost(pitch_deg_s, false));
  CHECK(lost(pitch_deg_s, true));
  CHECK(lost({0.0, 0.0, 4.5}, false));
}

TEST_CASE("one outlier is no contradiction, and a pause begins anew") {
  const Drive standing;
  LostDetector detector;
  for (int scan = 0; scan < 30; ++scan) {
    LostEvidence evidence = standing.at(scan);
    if (scan == 20) evidence.T_map_base.linear() = rotation_about_z(0.2);
    CHECK(detector.add(evidence) == LostReason::kNone);
  }
  for (int scan = 60; scan < 62; ++scan) {  // relocated by 11 degrees in 3 s without a scan
    LostEvidence evidence = standing.at(scan);
    evidence.T_map_base.linear() = rotation_about_z(0.2);
    CHECK(detector.add(evidence) == LostReason::kNone);
  }
}

}  // namespace isobar::test::test_lost_detector
