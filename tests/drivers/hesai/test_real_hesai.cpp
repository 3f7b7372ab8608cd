// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>

#include "drivers/hesai/decoder.hpp"
#include "tests/drivers/lidar/real_data.hpp"

namespace isobar::test::test_real_hesai {

TEST_CASE("Every point that another decoder finds in a real dual-return XT16 recording is decoded") {
  const std::filesystem::path folder = std::filesystem::path(ISOBAR_SHARED_DATA) / "hesai-xt16";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: " << folder.string() << " is not on this machine");
    return;
  }
  const auto packets = read_bag_packets(folder / "1732848127890747768_0.db3", kHesaiBag);
  REQUIRE(packets.size() == 1'626);
  LidarLimits limits;
  limits.min_range_m = 0.05;
  ScanAssembler assembler(std::make_unique<hesai::Decoder>(hesai::kXt16, limits));
  const auto scans = scans_of(assembler, packets);
  CHECK(assembler.counters().packets == 1'626);
  CHECK(assembler.counters().lost == 0);
  CHECK(scans.size() == 5);  // 0.33 s at 10 Hz, from azimuth 270 deg
  PointGrid grid;
  for (const auto& scan : scans) grid.add(*scan);
  const auto truth = read_truth_pcd(folder / "1732848128093928016.pcd");
  REQUIRE(truth.size() == 26'287);
  std::vector<double> errors_m;
  for (const auto& point : truth) errors_m.push_back(grid.nearest(point).apart_m);
  std::sort(errors_m.begin(), errors_m.end());
  CHECK(errors_m[errors_m.size() / 2] < 1e-5);
  CHECK(errors_m.back() < 1e-4);  // the same tables in single precision, tens of metres away
}

}  // namespace isobar::test::test_real_hesai
