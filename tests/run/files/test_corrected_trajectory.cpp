// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "core/errors.hpp"
#include "run/files/corrected_trajectory.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_corrected_trajectory {
namespace {

Eigen::Isometry3d raised(std::int64_t /*stamp_ns*/, const Eigen::Isometry3d& T_map_base) {
  return Eigen::Translation3d(0.0, 0.0, 0.5) * T_map_base;
}

constexpr const char* kTwoPoses =
    "# t_s x_m y_m z_m qx qy qz qw\n"
    "1700000000.123456789 1 2 3 0 0 0 1\n"
    "1700000000.223456789 1.5 2 3 0 0 0.6 0.8\n";

TEST_CASE("every pose of a trajectory is written corrected, with its stamp to the nanosecond") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / files::kTrajectoryFile, kTwoPoses);
  CHECK(files::write_corrected_trajectory(folder.path(), 1, raised) == 2);
  const std::string text = files::read_text_file(folder.path() / files::kCorrectedTrajectoryFile);
  CHECK(text.find("\n1700000000.123456789 1.000000 2.000000 3.500000 ") != std::string::npos);
  CHECK(text.find(
            "\n1700000000.223456789 1.500000 2.000000 3.500000 0.000000000 0.000000000 0.600000000 0.8") !=
        std::string::npos);
}

TEST_CASE("a line that a power cut left incomplete is left out") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / files::kTrajectoryFile, std::string(kTwoPoses) + "1700000000.3 1.7");
  CHECK(files::write_corrected_trajectory(folder.path(), 1, raised) == 2);
}

TEST_CASE("a damaged line is an error with its place, and the file of before stays") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / files::kTrajectoryFile, "not a pose\n" + std::string(kTwoPoses));
  files::write_text_file(folder.path() / files::kCorrectedTrajectoryFile, "as it was\n");
  CHECK_THROWS_WITH_AS(static_cast<void>(files::write_corrected_trajectory(folder.path(), 1, raised)),
                       doctest::Contains("trajectory.tum:1: "), DataError);
  CHECK(files::read_text_file(folder.path() / files::kCorrectedTrajectoryFile) == "as it was\n");
}

TEST_CASE("each map frame has its own file, which belongs to the run") {
  const TemporaryFolder folder;
  files::write_text_file(folder.path() / "trajectory_2.tum", kTwoPoses);
  CHECK(files::write_corrected_trajectory(folder.path(), 2, raised) == 2);
  CHECK(std::filesystem::exists(folder.path() / "trajectory-corrected_2.tum"));
  files::remove_run(folder.path());
  CHECK(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace isobar::test::test_corrected_trajectory
