// SPDX-License-Identifier: BSD-3-Clause
// A live Ouster with 128 channels, whose packets have 25 kB and whose IMU comes to a second port: what is recorded is
// what was sent, and its replay is the live run.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "daemon/input_tap.hpp"
#include "daemon/lidar_thread.hpp"
#include "daemon/replay.hpp"
#include "daemon/run_description.hpp"
#include "drivers/clock/robot_clock.hpp"
#include "run/recording/record_session.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/drivers/ouster/packet_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_lidar_recorded {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

namespace {

constexpr std::uint16_t kDataPort = 47'502;
constexpr std::uint16_t kImuPort = 47'503;
constexpr int kTurns = 32;  // the map begins after 2.5 s of rest
constexpr int kColumnsPerTurn = 1'024;
constexpr std::uint64_t kImuNs = 10'000'000;

/// A datagram that the sensor sends.
struct Sent {
  std::uint64_t at_ns = 0;  ///< on the sensor's clock
  std::uint16_t port = 0;
  std::vector<std::uint8_t> bytes;
};

/// The sensor stands in a room of 16 x 12 x 2.4 m.
OusterPlan room_plan() {
  OusterPlan plan;
  plan.rows = 128;
  plan.columns_per_turn = kColumnsPerTurn;
  plan.target = [](int id, int row, int /*number*/) {
    const double azimuth = 2.0 * std::numbers::pi * id / kColumnsPerTurn;
    const double elevation = (22.5 - 45.0 * row / 127.0) * std::numbers::pi / 180.0;
    const double wall_m = std::min(8.0 / std::abs(std::cos(azimuth)), 6.0 / std::abs(std::sin(azimuth)));
    const double range_m = std::min(wall_m / std::cos(elevation), 1.2 / std::abs(std::sin(elevation)));
    return OusterReturn{static_cast<std::uint32_t>(std::lround(range_m * 1e3)), 40};
  };
  return plan;
}

/// Data and IMU packets in the order of their times.
std::vector<Sent> traffic(OusterPlan plan) {
  std::vector<Sent> sent;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.001F);
  const std::uint64_t start_ns = plan.first_ns;
  std::uint64_t imu_ns = start_ns;
  const double column_ns = 1e9 / (plan.columns_per_turn * plan.hz);
  for (int column = 0; column < kTurns * kColumnsPerTurn; column += plan.columns_per_packet) {
    plan.first_id = column % kColumnsPerTurn;
    plan.frame_id = static_cast<std::uint16_t>(7 + column / kColumnsPerTurn);
    plan.first_ns = start_ns + static_cast<std::uint64_t>(std::llround(column * column_ns));
    for (; imu_ns <= plan.first_ns; imu_ns += kImuNs) {
      sent.push_back({imu_ns, kImuPort,
                      build_ouster_imu(imu_ns, {noise(random), noise(random), 1.0F + noise(random)},
                                       {noise(random), noise(random), noise(random)})});
    }
    sent.push_back({plan.first_ns, kDataPort, build_ouster_packet(plan)});
  }
  return sent;
}

Config config_of(const std::filesystem::path& metadata) {
  Config config;
  config.lidar.model = "OS1";
  config.lidar.address = "127.0.0.1";
  config.lidar.port = kDataPort;
  config.lidar.info_port = kImuPort;
  config.lidar.calibration_file = metadata.string();
  config.imu.source = ImuSource::kLidar;
  config.barometer.source = BarometerSource::kNone;
  config.wheel.source = WheelSource::kNone;
  return config;
}

/// The lidar thread with a recorder.
struct Rig {
  Rig(const Config& config, const std::filesystem::path& folder)
      : lidar(stage_settings(config), config.lidar, ThreadSettings{"lidar", 0, {}}), session(folder) {
    recording::InputLog head;
    REQUIRE(head.add_description(RobotClock::offset_ns(), recording::manifest_text(manifest_of(config)),
                                 settings_in_force(config)));
    take(head);
    lidar.worker().start();
  }
  void take(const recording::InputLog& records) {
    recording::InputLogReader reader(records.bytes());
    recording::LogEntry entry;
    while (reader.next(entry)) session.add(entry);
  }
  void drain() {
    log.clear();
    tap.drain(log);
    take(log);
  }
  [[nodiscard]] std::uint64_t received() const {
    const LidarStatus status = lidar.status();
    return status.counters.packets + status.counters.no_points;
  }

  InputTap tap;
  LidarThread lidar;
  recording::RecordSession session;
  recording::InputLog log;
};

/// Sends in real time, but never more than the sockets hold on a machine that is busy.
void send(const std::vector<Sent>& sent, Rig& rig) {
  UdpSender data("127.0.0.1", kDataPort);
  UdpSender imu("127.0.0.1", kImuPort);
  const auto start = std::chrono::steady_clock::now();
  const auto patience = start + 60s;
  std::uint64_t count = 0;
  for (const Sent& datagram : sent) {
    std::this_thread::sleep_until(start + std::chrono::nanoseconds(datagram.at_ns - sent.front().at_ns));
    while (count - rig.received() > 4 && std::chrono::steady_clock::now() < patience)
      std::this_thread::sleep_for(50us);
    (datagram.port == kImuPort ? imu : data).send(datagram.bytes);
    if (++count % 16 == 0) rig.drain();  // every 20 ms
  }
  while (rig.received() < count && std::chrono::steady_clock::now() < patience)
    std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(450ms);  // two rounds without a datagram
  rig.drain();
}

}  // namespace

TEST_CASE(
    "every packet of a live Ouster and its IMU is recorded to the byte, and the replay is the live run") {
  const TemporaryFolder folder;
  const OusterPlan plan = room_plan();
  const auto metadata = folder.path() / "os1.json";
  std::ofstream(metadata) << build_ouster_metadata(plan, true, "OS-1-128");
  const Config config = config_of(metadata);
  const std::vector<Sent> sent = traffic(plan);
  const auto recorded = folder.path() / "recording";
  LidarStatus live;
  {
    const ipc::Broker broker;
    Rig rig(config, recorded);
    send(sent, rig);
    live = rig.lidar.status();
    rig.session.close();
    CHECK(rig.tap.lost() == 0);
    CHECK(rig.session.counts().packets == sent.size());
    CHECK(rig.session.counts().imu > kTurns * 9);
  }
  CHECK(live.info_refused == 0);
  CHECK(live.sync == LidarSync::kLocking);  // set to PTP, and it counts from its start

  recording::RecordingReader reader(recorded);
  CHECK(reader.manifest().lidar->port == kDataPort);
  CHECK(reader.manifest().lidar->info_port == kImuPort);
  // Two sockets are read one after the other: each port in its order.
  std::vector<const Sent*> data;
  std::vector<const Sent*> imu;
  for (const Sent& datagram : sent) (datagram.port == kImuPort ? imu : data).push_back(&datagram);
  auto next_data = data.begin();
  auto next_imu = imu.begin();
  recording::Event event;
  while (reader.next(event)) {
    if (event.kind != recording::EventKind::kLidarPacket) continue;
    auto& next = event.port == kImuPort ? next_imu : next_data;
    REQUIRE(next != (event.port == kImuPort ? imu.end() : data.end()));
    REQUIRE(std::ranges::equal(event.packet, (*next)->bytes));
    CHECK(event.sender_ipv4 == 0x7F00'0001U);
    ++next;
  }
  CHECK(next_data == data.end());
  CHECK(next_imu == imu.end());

  const ReplaySummary summary = replay(recorded, config, folder.path() / "run", [](double) {});
  // At the end a replay completes the open turn; a turn of 131 072 points is two scans.
  CHECK(summary.scans >= live.counters.scans);
  CHECK(summary.scans <= live.counters.scans + 2);
  CHECK(summary.registered > 0);
  const auto imu_samples = std::ranges::find(summary.counts, "imu samples", &files::RunCount::name);
  REQUIRE(imu_samples != summary.counts.end());
  CHECK(imu_samples->count >= imu.size() - 2);  // none before the first data packet
}

}  // namespace isobar::test::test_lidar_recorded
