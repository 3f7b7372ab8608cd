// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/mounts/corrected_mount.hpp"
#include "run/recording/manifest.hpp"
#include "simulation/simulate.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"
#include "tools/mount_replay.hpp"

namespace isobar::test::test_calibrate_mounts {

using test::TemporaryFolder;

namespace {

constexpr int kDataError = 65;
// Also of CLI11, see exit_code.hpp.
constexpr int kUsageError = 64;

/// A short run through two floors, 25 m with 540 deg of turns.
void simulate_run(const std::filesystem::path& folder, double stop_after_s = 60.0) {
  simulation::ScenarioRequest request;
  request.name = "three-floors";
  request.seed = 2;
  request.short_form = true;
  request.stop_after_s = stop_after_s;
  simulation::simulate(request, folder, {});
}

/// Makes the manifest wrong, so that `error_deg` is to be found in it.
void misplace_lidar(const std::filesystem::path& folder, const Eigen::Vector3d& error_deg) {
  std::vector<std::string> warnings;
  recording::Manifest manifest = recording::read_manifest(folder, warnings);
  manifest.lidar->mount.rpy_deg = corrected_rpy_deg(manifest.lidar->mount.rpy_deg, -error_deg * kRadPerDeg);
  recording::write_manifest(folder, manifest);
}

tools::MountReplay replay_mount(const std::filesystem::path& folder,
                                const Eigen::Vector3d& used_deg = {0.0, 0.0, 0.0}) {
  return tools::replay_for_mount(folder, Config{}, used_deg * kRadPerDeg, [](double) {});
}

int exit_of(const std::vector<std::string>& words) {
  std::vector<std::string> all{"calibrate", "mounts"};
  all.insert(all.end(), words.begin(), words.end());
  return test::exit_code(tools::add_calibrate_command, all);
}

}  // namespace

TEST_CASE(
    "an error put into the manifest is found on top of the simulated one: 0.1 deg in roll, pitch, 0.2 in "
    "yaw") {
  const TemporaryFolder folder;
  const auto recording = folder.path() / "run";
  simulate_run(recording);
  const tools::MountReplay right = replay_mount(recording);
  // Seed 2 sets the lidar on the robot with (-0.07, 0.09, 0.05) deg against IMU and wheels.
  CHECK(right.estimate.verdict == MountVerdict::kFound);
  CHECK((right.estimate.error_rad / kRadPerDeg).head<2>().cwiseAbs().maxCoeff() < 0.2);
  CHECK(right.way_m > 20.0);
  CHECK(right.turn_deg > 400.0);

  const Eigen::Vector3d error_deg(0.5, -0.8, 0.6);
  misplace_lidar(recording, error_deg);
  for (const Eigen::Vector3d& used_deg : {Eigen::Vector3d(0.0, 0.0, 0.0), error_deg}) {
    const tools::MountReplay found = replay_mount(recording, used_deg);
    CHECK(found.estimate.verdict == MountVerdict::kFound);
    CHECK(found.estimate.yaw_found);
    const Eigen::Vector3d added_deg =
        (found.estimate.error_rad - right.estimate.error_rad) / kRadPerDeg - error_deg;
    CHECK(added_deg.head<2>().cwiseAbs().maxCoeff() < 0.1);
    CHECK(std::abs(added_deg.z()) < 0.2);
  }
  CHECK(exit_of({recording}) == 0);
}

TEST_CASE("recordings without turns, of different mounts, or that are none end with an error") {
  const TemporaryFolder folder;
  const auto standing = folder.path() / "standing";
  simulate_run(standing, 6.0);
  CHECK(replay_mount(standing).estimate.verdict == MountVerdict::kUnknown);
  CHECK(exit_of({standing}) == kDataError);
  CHECK(exit_of({folder.path() / "nowhere"}) == kDataError);
  CHECK(exit_of({}) == kUsageError);

  const auto first = folder.path() / "first";
  const auto second = folder.path() / "second";
  simulate_run(first);
  std::filesystem::copy(first, second, std::filesystem::copy_options::recursive);
  CHECK(exit_of({first, standing}) == 0);
  misplace_lidar(second, {0.0, 1.0, 0.0});
  CHECK(exit_of({first, second}) == kDataError);
}

}  // namespace isobar::test::test_calibrate_mounts
