// SPDX-License-Identifier: BSD-3-Clause
// Eleven consecutive VLP-16 scans of a corridor, recorded by others; skipped where the files are missing.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/map/local_map.hpp"
#include "core/registration/registration.hpp"

namespace isobar::test::test_real_corridor {

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace)

constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kStepNs = 400'000'000;  // the files have no times; a brisk walk
constexpr std::size_t kPointBytes = 32;        // x, y, z as floats, then unused fields

bool load_pcd(const std::filesystem::path& file, Scan& scan) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  while (std::getline(stream, line) && line.rfind("DATA", 0) != 0) {
  }
  scan.point_count = 0;
  std::array<char, kPointBytes> record{};
  while (stream.read(record.data(), record.size()) && scan.point_count < Scan::kMaxPoints) {
    std::array<float, 3> xyz{};
    std::memcpy(xyz.data(), record.data(), sizeof(xyz));
    scan.points[scan.point_count++] = {xyz[0], xyz[1], xyz[2], 0, 0, 0};
  }
  return scan.point_count > 0;
}

// Prior of a platform with unknown motion that stays on the ground.
Prior ignorant_prior(std::int64_t stamp_ns) {
  Prior prior;
  prior.stamp_ns = stamp_ns;
  prior.attitude_valid = true;
  prior.yaw_rate_variance_rad2_s2 = 0.15 * 0.15;
  return prior;
}

}  // namespace

TEST_CASE("eleven real scans of a corridor follow each other in steps of half a metre and more") {
  const std::filesystem::path folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "vlp16-corridor";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: " << folder.string() << " does not exist");
    return;
  }
  Registration registration(RegistrationConfig{}, Method::k6Dof, Eigen::Isometry3d::Identity());
  LocalMap map(MapConfig{}, Eigen::Isometry3d::Identity());
  auto scan = std::make_unique<Scan>();
  auto out = std::make_unique<RegisteredScan>();
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i < 11; ++i) {
    REQUIRE(load_pcd(folder / (std::to_string(8 + i) + ".pcd"), *scan));
    scan->stamp_ns = kStart + i * kStepNs;
    scan->end_stamp_ns = scan->stamp_ns;
    scan->sequence = static_cast<std::uint32_t>(i);
    registration.add_prior(ignorant_prior(scan->stamp_ns));
    registration.register_scan(*scan, *map.snapshot(), *out);
    map.update(*out);
    const Eigen::Vector3d now = out->pose.T_map_base.translation();
    CAPTURE(i);
    CAPTURE((now - before).transpose());
    CAPTURE(out->pose.overlap);
    CAPTURE(out->pose.residual_rms_m);
    if (i > 0) {
      CHECK(out->pose.mode == PoseMode::kRegistered);
      // Steps by the description of the data: 0.50 to 0.77 m; tolerance: a tenth, for the description's
      // error.
      CHECK((now - before).norm() > 0.45);
      CHECK((now - before).norm() < 0.85);
      CHECK(out->pose.overlap > 0.5);
      CHECK(out->pose.residual_rms_m < 0.05);
    }
    before = now;
  }
}

}  // namespace isobar::test::test_real_corridor
