// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lidar/lidar_time.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <memory>

#include "drivers/lidar/scan_assembler.hpp"

namespace isobar::test::test_lidar_time {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kMillisecondNs = 1'000'000;
constexpr std::int64_t kStartNs = 1'700'000'000 * kSecondNs;

constexpr std::int64_t kColumns = 200;
constexpr std::int64_t kColumnNs = 100 * kMillisecondNs / kColumns;

/// A lidar of 200 columns a turn of 100 ms. A packet is the time of one column.
class Turning final : public LidarDecoder {
 public:
  explicit Turning(const LidarSync& sync) : sync_(sync) {}
  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override {
    std::memcpy(&packet.device_ns, payload.data(), sizeof packet.device_ns);
    packet.duration_ns = kColumnNs;
    packet.column_ns = 0;
    packet.identity = static_cast<std::uint64_t>(packet.device_ns);
    packet.count = 1;
    packet.turn[0] =
        static_cast<std::uint32_t>(packet.device_ns / kColumnNs % kColumns * (kFullTurn / kColumns));
    packet.offset_ns[0] = 0;
    return DecodeStatus::kOk;
  }
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> /*payload*/) const override { return true; }
  std::uint32_t decode(std::span<const std::uint8_t> /*payload*/, const PacketColumns& /*packet*/,
                       int /*first*/, int /*end*/, std::int64_t since_start_ns,
                       ScanPoint* out) const override {
    *out = {1.0F, 0.0F, 0.0F, point_time(since_start_ns), 0, 0};
    return 1;
  }
  void set_limits(const LidarLimits& /*limits*/) override {}
  [[nodiscard]] std::string_view model() const override { return "turning"; }
  [[nodiscard]] std::uint32_t points_per_column() const override { return 1; }
  [[nodiscard]] std::size_t longest_packet() const override { return sizeof(std::int64_t); }
  [[nodiscard]] std::string mismatch() const override { return {}; }
  [[nodiscard]] LidarSync sync() const override { return sync_; }

 private:
  const LidarSync& sync_;
};

/// Stamp of the last of some scans minus its true time, for packets that arrive `latency_ns` after their firing; the
/// sensor's clock is ahead of the host's by `ahead_ns`.
std::int64_t stamp_error_ns(LidarTime time, LidarSync sync, std::int64_t ahead_ns, std::int64_t latency_ns,
                            bool* sensor_stamps = nullptr) {
  ScanAssembler assembler(std::make_unique<Turning>(sync), time);
  const auto scan = std::make_unique<Scan>();
  std::int64_t error_ns = -1;
  for (int packet = 0; packet < 3 * kColumns + 50; ++packet) {
    const std::int64_t true_ns = kStartNs + packet * kColumnNs;
    const std::int64_t device_ns = true_ns + ahead_ns;
    std::array<std::uint8_t, sizeof device_ns> payload{};
    std::memcpy(payload.data(), &device_ns, sizeof device_ns);
    // The n-th scan begins with packet 200 n.
    if (assembler.add_packet(payload, true_ns + latency_ns, *scan).scan_complete) {
      error_ns = scan->stamp_ns - (kStartNs + (packet / kColumns - 1) * 100 * kMillisecondNs);
    }
  }
  if (sensor_stamps != nullptr) *sensor_stamps = assembler.sensor_stamps();
  return error_ns;
}

}  // namespace

TEST_CASE("Two clocks that count the same seconds differ by whole ones, whatever the latency between them") {
  for (const std::int64_t seconds : {-1'700'000'000LL, -37LL, 0LL, 1LL, 3'600LL}) {
    for (const std::int64_t latency_ms : {-4, 0, 1, 17, 49}) {
      CAPTURE(latency_ms);
      CHECK(whole_seconds_ns(seconds * kSecondNs + latency_ms * kMillisecondNs) == seconds * kSecondNs);
    }
    for (const std::int64_t other_ms : {-400, -6, 51, 500}) {
      CAPTURE(other_ms);
      CHECK_FALSE(whole_seconds_ns(seconds * kSecondNs + other_ms * kMillisecondNs).has_value());
    }
  }
}

TEST_CASE(
    "A locked lidar stamps its points itself, where that is asked for: the latency of its packets is gone") {
  const std::int64_t latency_ns = 15 * kMillisecondNs;
  const std::int64_t tai_ns = 37 * kSecondNs;  // TAI is ahead of UTC
  CHECK(stamp_error_ns(LidarTime::kReceive, LidarSync::kLocked, tai_ns, latency_ns) == latency_ns);
  bool sensor_stamps = false;
  for (const LidarSync sync : {LidarSync::kLocked, LidarSync::kUnknown}) {
    CHECK(stamp_error_ns(LidarTime::kSensor, sync, tai_ns, latency_ns, &sensor_stamps) == 0);
    CHECK(sensor_stamps);
  }
}

TEST_CASE("A lidar that is not locked, or to other seconds, is stamped by receive times") {
  const std::int64_t latency_ns = 15 * kMillisecondNs;
  bool sensor_stamps = true;
  for (const LidarSync sync : {LidarSync::kFree, LidarSync::kLocking, LidarSync::kFault}) {
    CHECK(stamp_error_ns(LidarTime::kSensor, sync, 0, latency_ns, &sensor_stamps) == latency_ns);
    CHECK_FALSE(sensor_stamps);
  }
  CHECK(stamp_error_ns(LidarTime::kSensor, LidarSync::kLocked, 300 * kMillisecondNs, latency_ns,
                       &sensor_stamps) == latency_ns);
  CHECK_FALSE(sensor_stamps);
}

}  // namespace isobar::test::test_lidar_time
