// SPDX-License-Identifier: BSD-3-Clause
// Writes generated seed inputs for every fuzz target into the given folder.
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "run/recording/recording_writer.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "tests/drivers/hesai/packet_builder.hpp"
#include "tests/drivers/robosense/packet_builder.hpp"
#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/drivers/vn100/packet_writer.hpp"
#include "tests/drivers/xsens/message_writer.hpp"
#include "tests/fuzz/import_seeds.hpp"
#include "tests/fuzz/lidar_seeds.hpp"

namespace {

using namespace isobar;

std::filesystem::path root;

void save(const std::string& target, const std::string& name, const std::string& content) {
  std::filesystem::create_directories(root / target);
  std::ofstream(root / target / name, std::ios::binary) << content;
}

std::string load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

test::PacketPlan plan_of(int n, std::uint8_t product_id, std::uint8_t mode) {
  test::PacketPlan plan;
  plan.product_id = product_id;
  plan.return_mode = mode;
  plan.timestamp_us = static_cast<std::uint32_t>(3'599'990'000LL + n * 1'327) % 3'600'000'000U;
  plan.first_azimuth_deg = 355.0 + n * 2.4;
  return plan;
}

/// Five packets for the model of this number in fuzz_lidar.
template <class MakePacket>
void lidar_seed(int model, const std::string& name, const MakePacket& packet_of) {
  std::string stream(1, static_cast<char>(model));
  for (int n = 0; n < 5; ++n) {
    const std::vector<std::uint8_t> packet = packet_of(n);
    stream += '\0';  // option byte
    stream += static_cast<char>(packet.size() & 0xFFU);
    stream += static_cast<char>(packet.size() >> 8U);
    stream.append(2, '\0');
    stream.append(packet.begin(), packet.end());
  }
  save("fuzz_lidar", name, stream);
}

void lidar_seeds() {
  constexpr std::array<std::uint8_t, 4> kProductIds{0x22, 0x24, 0x28, 0x21};
  for (int model = 0; model < 4; ++model) {
    for (const std::uint8_t mode : {0x37, 0x39}) {
      const std::uint8_t id = kProductIds[static_cast<std::size_t>(model)];
      lidar_seed(model, std::to_string(id) + "-" + std::to_string(mode),
                 [&](int n) { return test::build_packet(plan_of(n, id, mode)); });
    }
  }
  for (const int lasers : {16, 32}) {
    lidar_seed(lasers == 16 ? 4 : 5, "hesai-" + std::to_string(lasers), [&](int n) {
      test::HesaiPlan plan;
      plan.lasers = lasers;
      plan.microsecond = static_cast<std::uint32_t>(n) * 400;
      plan.first_azimuth_deg = 359.0 + 1.44 * n;
      return test::build_packet(plan);
    });
  }
  for (const bool is_helios : {false, true}) {
    lidar_seed(is_helios ? 7 : 6, is_helios ? "helios" : "rs16", [&](int n) {
      if (n == 2)
        return test::build_helios_difop({15, 13, 11, 9, 7, 5, 3, 1, -1, -3, -5, -7, -9, -11, -13, -15}, {},
                                        0);
      test::RobosensePlan plan;
      plan.is_helios = is_helios;
      plan.time_us += n * 1'333;
      plan.first_azimuth_deg = 355.0 + 4.8 * n;
      return test::build_packet(plan);
    });
  }
}

void imu_seeds() {
  std::string vn100(1, '\x20');
  std::string xsens(1, '\x20');
  for (int n = 0; n < 5; ++n) {
    const auto packet = test::own_packet(static_cast<std::uint64_t>(n) * 5'000'000);
    vn100.append(packet.begin(), packet.end());
    vn100 += "$VNRRG,5,9600*65\r\n$GPRMC,000012.800,V,,,,,0.00,0.00,060180,,,N*49\r\n";
    vn100 +=
        "$VNMAR,+1.0684,-0.2578,+3.0649,-00.005,+00.341,-09.780,-0.000963,+0.000840,-0.000466,S0001*2D\r\n";
    const auto message =
        test::own_message(static_cast<std::uint16_t>(n), static_cast<std::uint32_t>(n) * 100, 0.25, 101'000);
    xsens.append(message.begin(), message.end());
    const auto other =
        test::MessageWriter().numbers(0x2032, {1, 2, 3}).numbers(0x4011, {1, 2, 3}).finish(true);
    xsens.append(other.begin(), other.end());
  }
  save("fuzz_vn100", "stream", vn100);
  save("fuzz_xsens", "stream", xsens);
}

void recording_seeds() {
  const auto folder = root / "recording";
  std::filesystem::remove_all(folder);
  recording::RecordingWriter writer(folder, recording::Manifest::with_all_sensors());
  constexpr std::int64_t kStart = 1'700'000'000'000'000'000;
  for (std::int64_t i = 0; i < 5; ++i) {
    const std::int64_t stamp_ns = kStart + i * 100'000'000;
    ImuSample imu;
    imu.stamp_ns = stamp_ns;
    imu.accel_m_s2.z() = 9.81;
    imu.has_attitude = true;
    writer.add_imu(imu);
    writer.add_pressure({stamp_ns, 100'000.5, 20.0});
    writer.add_base_pressure({stamp_ns + 1'000'000'000'000, 100'010.25, 21.0});
    writer.add_wheel({stamp_ns, 0.5, 0.0, 0.1});
    writer.add_packet(stamp_ns, std::vector<std::uint8_t>(64, static_cast<std::uint8_t>(i)));
    writer.add_reference(stamp_ns, Eigen::Isometry3d::Identity());
  }
  writer.add_segment({kStart, kStart + 1'000'000'000, "flat"});
  writer.close();
  const std::string capture = load(folder / "lidar.pcap");
  save("fuzz_pcap", "nanoseconds", capture);
  // A pcapng file: a section, an interface with nanoseconds, an empty packet.
  save("fuzz_pcap", "blocks",
       std::string(
           "\x0A\x0D\x0D\x0A\x1C\0\0\0\x4D\x3C\x2B\x1A\1\0\0\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x1C\0\0\0"
           "\1\0\0\0\x20\0\0\0\1\0\0\0\0\0\0\0\x09\0\1\0\x09\0\0\0\0\0\0\0\x20\0\0\0"
           "\6\0\0\0\x20\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x20\0\0\0",
           92));
  save("fuzz_recording", "all",
       load(folder / "imu.csv") + "\x01" + load(folder / "barometer.csv") + "\x01" +
           load(folder / "base_barometer.csv") + "\x01" + load(folder / "wheel.csv") + "\x01" +
           capture.substr(24) + "\x01\x01\x01\x01" + load(folder / "reference.tum") + "\x01" +
           load(folder / "segments.csv"));
  save("fuzz_toml", "manifest", load(folder / "recording.toml"));
}

void tile_store_seeds() {
  const auto folder = root / "map";
  {
    const auto store = FileTileStore::create(folder, {}, {});
    for (int n = 0; n < 5; ++n)
      store->put({n % 4, n, -n}, std::vector<std::byte>(static_cast<std::size_t>(20 + n)));
  }
  const std::string tiles = load(folder / "00000000.tiles");
  const std::string index = load(folder / "00000000.index");
  const auto length = [](const std::string& text) {
    return std::string{static_cast<char>(text.size() & 255U), static_cast<char>(text.size() >> 8U)};
  };
  save("fuzz_tile_store", "whole", length(tiles) + length(index) + tiles + index);
  save("fuzz_tile_store", "no_index", length(tiles) + length("") + tiles);
  save("fuzz_tile_store", "header",
       length(tiles) + length("") + tiles + "format = 1\ntile_m = 8.0\ncell_m = 0.25\n");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: make_seeds FOLDER\n");
    return 64;
  }
  root = arguments[1];
  lidar_seeds();
  imu_seeds();
  test::write_lidar_seeds(root);
  test::write_import_seeds(root);
  recording_seeds();
  tile_store_seeds();
  save("fuzz_toml", "config", show_config(Config{}));
  save("fuzz_toml", "floors", "[[floor]]\nheight_m = 3.05\nname = \"First\"\n");
  save("fuzz_toml", "short",
       "method = \"4dof\"\n[lidar]\nmodel = \"HDL-32E\"\nxyz_m = [0.1, 0, 0.45]\n[map]\ncell_m = 0.3\n");
  save("fuzz_pressure_log", "own", "t_ns,pressure_pa,temperature_c\n1586000000000000000,98712.5,21.5\n");
  save("fuzz_pressure_log", "logger",
       "\"TOA5\",\"X\"\r\n\"TIMESTAMP\",\"P_Avg\",\"Ta\"\r\n\"TS\",\"hPa\",\"degC\"\r\n"
       "\"2020-04-04 00:00:00\",986.5,20\r\n\"2020-04-04T00:01:00+02:00\",nan,20\r\n");
  save("fuzz_pressure_log", "two_columns",
       "Datum;Uhrzeit;Luftdruck (mm Hg);Temp "
       "(F)\n14.11.2023;23:59:59,5;760,1;73,4\n14.11.2023;22:59:59;760,1;73,4\n");
  save("fuzz_pressure_log", "seconds",
       "header.stamp.sec,header.stamp.nanosec,fluid_pressure\n1700000000,0,101000\n1700000000,0,101001\n");
  save("fuzz_dps310", "sound", std::string(600, '\0'));
  for (char sensor = 0; sensor < 4; ++sensor) {
    save("fuzz_barometers", "sound" + std::to_string(sensor),
         std::string(1, sensor) + std::string(600, '\0'));
    save("fuzz_barometers", "free" + std::to_string(sensor),
         std::string(1, sensor) + std::string(40, '\0') + std::string(400, '\x21'));
  }
  save("fuzz_dps310", "free", std::string(40, '\0') + std::string(400, '\x21'));
  save(
      "fuzz_datagram", "all",
      "imu,1,1700000000000000000,0.1,0.2,-0.3,0,0,9.81,1,0,0,0\nbaro,1,1700000000000000000,100000.5,20.25\r\n"
      "base,4294967295,0,1e5,nan\nwheel,7,5,0.5,0,0.1\n");
  save("fuzz_web", "hint",
       "robot7.local:8080\nBearer 0123456789abcdef\n{\"x_m\": 1, \"y_m\": -2.5, \"yaw_deg\": 90}");
  save("fuzz_web", "ipv6", "[fe80::1]:80\nBearer \n[[]]");
  return 0;
}
