// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/lidar_seeds.hpp"

#include <fstream>
#include <string>
#include <vector>

#include "tests/drivers/livox/packet_builder.hpp"
#include "tests/drivers/ouster/packet_builder.hpp"

namespace isobar::test {
namespace {

void save_seed(const std::filesystem::path& folder, const std::string& name, const std::string& content) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name, std::ios::binary) << content;
}

/// A packet with option byte and length in front.
std::string framed(char options, const std::vector<std::uint8_t>& packet) {
  std::string text{options, static_cast<char>(packet.size() & 255U), static_cast<char>(packet.size() >> 8U),
                   0};
  text.append(packet.begin(), packet.end());
  return text;
}

}  // namespace

void write_lidar_seeds(const std::filesystem::path& root) {
  const std::vector<const char*> profiles{
      "LEGACY",          "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
      "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL",   "FUSA_RNG15_RFL8_NIR8_DUAL"};
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    OusterPlan plan;
    plan.profile = profiles[i];
    plan.rows = 4;
    plan.columns_per_turn = 512;
    std::string stream(1, static_cast<char>(i));
    for (int n = 0; n < 8; ++n) {
      plan.first_id = (448 + 16 * n) % 512;
      plan.first_ns += 3'125'000;
      stream += framed(n < 6 ? 0 : 2, build_ouster_packet(plan));
    }
    stream += framed(0, build_ouster_imu(plan.first_ns, {0.0F, 0.0F, 1.0F}, {1.0F, 2.0F, 3.0F}));
    save_seed(root / "fuzz_ouster", profiles[i], stream);
    save_seed(root / "fuzz_ouster_metadata", profiles[i], build_ouster_metadata(plan, i % 2 == 0));
  }
  LivoxPacket packet;
  std::string stream(1, 0);
  for (int n = 0; n < 8; ++n) {
    packet.timestamp_ns += 480'000;
    const std::vector<LivoxPoint> points(20, {1'000 * n + 500, -3'000, 200, 50, 0});
    stream += framed(n < 6 ? 0 : 2, n % 2 == 0 ? packet.points(points) : packet.short_points(points));
  }
  stream += framed(0, packet.imu({0.1F, 0.2F, 0.3F}, {0.0F, 0.0F, 1.0F}));
  save_seed(root / "fuzz_livox", "all", stream);
}

}  // namespace isobar::test
