// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/errors.hpp"
#include "run/evaluation/run_folder.hpp"
#include "run/files/pose_writer.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_run_folder {

using namespace isobar::evaluation;
using isobar::test::TemporaryFolder;

namespace {

PoseEstimate some_pose(std::uint32_t i) {
  PoseEstimate pose;
  pose.stamp_ns = 1'700'000'000'123'456'789 + 100'000'000LL * i;
  pose.sequence = i;
  pose.mode = PoseMode::kRegistered;
  pose.effective_method = Method::k4DofAltitude;
  pose.T_map_base.translation() = Eigen::Vector3d(0.1 * i, -2.5, 1e-3 * i);
  pose.T_map_base.linear() =
      Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      pose.covariance(row, column) = pose.covariance(column, row) = 0.1 * i + 0.01 * row + 1e-9 * column;
    }
  }
  pose.covariance(2, 2) = 0.0004;
  pose.registration_ms = 12.5;
  pose.altimeter = {.bias_m = 0.1 * i,
                    .bias_sd_m = 0.05,
                    .innovation_m = -0.02,
                    .faulty = i % 2 == 1,
                    .drifts = DriftSuspect::kBase,
                    .airflow_s2_m = 0.017,
                    .airflow_sd_s2_m = 0.002};
  return pose;
}

}  // namespace

TEST_CASE("poses and status rows come back from the folder of a run as they were written") {
  const TemporaryFolder folder;
  files::PoseWriter writer(folder.path() / "new" / "run");
  for (std::uint32_t i = 0; i < 50; ++i) writer.add(some_pose(i), i == 7 ? NAN : 0.25 * i, 0.05);
  CHECK(writer.count() == 50);
  writer.flush();

  const RunFolder run = read_run_folder(folder.path() / "new" / "run", 100);
  REQUIRE(run.trajectory.poses.size() == 50);
  REQUIRE(run.status.size() == 50);
  REQUIRE(run.covariances.size() == 50);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const PoseEstimate pose = some_pose(i);
    CHECK(run.trajectory.poses[i].stamp_ns == pose.stamp_ns);
    // Resolution of the file: six decimals of a metre, nine of a quaternion.
    CHECK((run.trajectory.poses[i].position_m - pose.T_map_base.translation()).norm() < 1e-6);
    CHECK(run.trajectory.poses[i].attitude.angularDistance(Eigen::Quaterniond(pose.T_map_base.linear())) <
          1e-7);
    CHECK(run.covariances[i].stamp_ns == pose.stamp_ns);
    CHECK((run.covariances[i].covariance - pose.covariance).cwiseAbs().maxCoeff() <
          6e-9);  // nine digits of 5
    CHECK(run.status[i].stamp_ns == pose.stamp_ns);
    CHECK(run.status[i].mode == "registered");
    CHECK(run.status[i].scan_ms == doctest::Approx(12.5));
    CHECK(run.status[i].sd_z_m == doctest::Approx(0.02));
    if (i != 7) CHECK(run.status[i].altimeter_height_m == doctest::Approx(0.25 * i));
  }
  CHECK(std::isnan(run.status[7].altimeter_height_m));
  CHECK(run.map.points.empty());
}

TEST_CASE("status.csv has the altimeter's bias of the adaptive method, and nan of the others") {
  const TemporaryFolder folder;
  files::PoseWriter writer(folder.path());
  PoseEstimate pose = some_pose(3);
  writer.add(pose, 1.0, 0.05);
  pose.effective_method = Method::kAdaptive;
  writer.add(pose, 1.0, 0.05);
  writer.flush();
  const std::vector<StatusRow> rows = read_run_folder(folder.path(), 100).status;
  REQUIRE(rows.size() == 2);
  CHECK(std::isnan(rows[0].altimeter_bias_m));
  CHECK(std::isnan(rows[0].altimeter_innovation_m));
  CHECK(rows[1].altimeter_bias_m == doctest::Approx(0.3));
  CHECK(rows[1].altimeter_bias_sd_m == doctest::Approx(0.05));
  CHECK(rows[1].altimeter_innovation_m == doctest::Approx(-0.02));
  CHECK(rows[1].altimeter_faulty);
  CHECK(rows[1].altimeter_drifts == "base_station");
  CHECK(std::isnan(rows[0].airflow_s2_m));
  CHECK(rows[1].airflow_s2_m == doctest::Approx(0.017));
  CHECK(rows[1].airflow_sd_s2_m == doctest::Approx(0.002));
}

TEST_CASE("a run that an older version began goes on with the columns of its status.csv") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "status.csv";
  const std::string_view all = files::kStatusColumns;
  const std::string older(all.substr(0, all.find(",altimeter_bias_m")));
  files::write_text_file(file, older + "\n");
  files::PoseWriter writer(folder.path(), files::Start::kContinue);
  writer.add(some_pose(1), 1.0, 0.05);
  writer.add(some_pose(2), 1.0, 0.05);
  writer.flush();
  const std::vector<StatusRow> rows = parse_status_csv(files::read_text_file(file), "s");
  REQUIRE(rows.size() == 2);
  CHECK(rows[1].stamp_ns == some_pose(2).stamp_ns);
  CHECK(rows[1].sd_z_m == doctest::Approx(0.02));
  CHECK(std::isnan(rows[1].altimeter_bias_m));
}

TEST_CASE("stamps before 1970 and huge values give lines that can be read back") {
  const TemporaryFolder folder;
  files::PoseWriter writer(folder.path());
  PoseEstimate pose = some_pose(1);
  pose.stamp_ns = -1'500'000'000;
  pose.T_map_base.translation().setConstant(1e300);
  pose.residual_rms_m = -1e308;
  pose.overlap = INFINITY;
  writer.add(pose, -NAN, INFINITY);
  writer.flush();
  const RunFolder run = read_run_folder(folder.path(), 100);
  CHECK(run.trajectory.poses[0].stamp_ns == -1'500'000'000);
  CHECK(run.trajectory.poses[0].position_m.x() == doctest::Approx(1e300));
  CHECK(run.status.size() == 1);
}

TEST_CASE("status.csv requires t_ns only, ignores unknown columns, and errors name line and column") {
  const auto rows = parse_status_csv("extra,scan_ms,t_ns\n1,,5\n2,3.5,6\n", "s");
  REQUIRE(rows.size() == 2);
  CHECK(std::isnan(rows[0].scan_ms));
  CHECK(rows[1].scan_ms == 3.5);
  CHECK(std::isnan(rows[1].sd_z_m));
  CHECK(message_of([] { parse_status_csv("scan_ms\n1\n", "s"); }) == "s:1: column 't_ns' is missing");
  CHECK(message_of([] { parse_status_csv("t_ns,scan_ms\n1,fast\n", "s"); }) ==
        "s:2: scan_ms: 'fast' is not a number");
}

TEST_CASE("status.csv and map.ply of a run that was killed are used as far as they are good") {
  const auto rows = parse_status_csv("t_ns,mode,scan_ms\n5,registered,1.5\n6,registered,2.5\n7,regis", "s");
  CHECK(rows.size() == 2);
  CHECK(parse_status_csv("t_ns,scan_ms\n5,1.5\n6,n", "s").size() == 1);
  CHECK_THROWS_AS(parse_status_csv("t_ns,mode\n5\n6,registered\n", "s"), DataError);
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / "trajectory.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  files::write_text_file(folder.path() / "map.ply", "");
  const RunFolder run = read_run_folder(folder.path(), 100);
  CHECK(run.trajectory.poses.size() == 2);
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes[0] == (folder.path() / "map.ply").string() + ": has no 'end_header'; the map is left out.");
}

TEST_CASE("a folder without a trajectory is refused") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(read_run_folder(folder.path(), 100), DataError);
}

TEST_CASE("a run without covariance.csv is read; a cut last line is left out, a bad one is an error") {
  const TemporaryFolder folder;
  files::PoseWriter writer(folder.path());
  for (std::uint32_t i = 0; i < 3; ++i) writer.add(some_pose(i), 0.0, 0.05);
  writer.flush();
  const std::string whole = files::read_text_file(folder.path() / "covariance.csv");
  CHECK(parse_covariance_csv(whole, "c").size() == 3);
  CHECK(parse_covariance_csv(whole.substr(0, whole.size() - 40), "c").size() == 2);
  CHECK(message_of([] { parse_covariance_csv("t_ns,x_x\n1,2\n", "c"); }) == "c:1: column 'x_y' is missing");
  std::string bad = whole;
  bad.replace(bad.find('\n') + 21, 1, "x");
  CHECK_THROWS_AS(parse_covariance_csv(bad, "c"), DataError);
  std::filesystem::remove(folder.path() / "covariance.csv");
  CHECK(read_run_folder(folder.path(), 100).covariances.empty());
}

}  // namespace isobar::test::test_run_folder
