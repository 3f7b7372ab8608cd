// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry.hpp"
#include "drivers/robosense/decoder.hpp"
#include "tests/drivers/lidar/real_data.hpp"

namespace isobar::test::test_real_robosense {

TEST_CASE("Every point that another decoder finds in a real Helios-16P recording is decoded, with its ring") {
  const std::filesystem::path folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "robosense-helios16";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: " << folder.string() << " is not on this machine");
    return;
  }
  auto packets = read_bag_packets(folder / "helios16p_0.db3", kRobosenseBag);
  REQUIRE(packets.size() == 751);
  // The recording holds one device information, in its fourth message. It comes first here: the angles are the
  // sensor's for as long as it lives.
  std::stable_partition(packets.begin(), packets.end(),
                        [](const RawPacket& p) { return p.bytes[0] == 0xA5; });
  LidarLimits limits;
  limits.min_range_m = 0.1;
  ScanAssembler assembler(std::make_unique<robosense::Decoder>(robosense::kHelios16p, limits));
  const auto scans = scans_of(assembler, packets);
  CHECK(assembler.counters().packets == 750);
  CHECK(assembler.counters().no_points == 1);
  CHECK(assembler.counters().lost == 0);
  CHECK(scans.size() >= 5);
  CHECK(scans.size() <= 6);
  PointGrid grid;
  for (const auto& scan : scans) grid.add(*scan);
  const auto truth = read_truth_pcd(folder / "1691031766880833506.pcd");
  REQUIRE(truth.size() == 15'795);
  std::vector<double> errors_m;
  double largest_rad = 0.0;
  std::size_t wrong_rings = 0;
  for (const auto& point : truth) {
    const NearestPoint nearest = grid.nearest(point);
    errors_m.push_back(nearest.apart_m);
    largest_rad = std::max(largest_rad, nearest.apart_m / std::hypot(point.x_m, point.y_m, point.z_m));
    wrong_rings += nearest.point.ring != point.channel ? 1 : 0;
  }
  std::sort(errors_m.begin(), errors_m.end());
  MESSAGE("median " << errors_m[errors_m.size() / 2] * 1e3 << " mm, largest " << errors_m.back() * 1e3
                    << " mm");
  CHECK(errors_m[errors_m.size() / 2] < 1e-4);
  // The other decoder lost 0.01 deg of one channel in a conversion, and takes another rotation for the last block
  // of a packet: together 0.03 deg.
  CHECK(largest_rad < 0.031 * kRadPerDeg);
  CHECK(wrong_rings == 0);
}

}  // namespace isobar::test::test_real_robosense
