// SPDX-License-Identifier: BSD-3-Clause
// Files that others recorded (../shared/data, never committed): skipped where they are missing.
#include <doctest/doctest.h>

#include <cmath>

#include "core/errors.hpp"
#include "drivers/lidar/scan_assembler.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/import/import_source.hpp"

namespace isobar::test::test_import_real {
namespace {

using namespace tools;

const std::filesystem::path kShared = ISOBAR_SHARED_DATA;

bool is_there(const char* name) {
  if (std::filesystem::exists(kShared / name)) return true;
  MESSAGE("skipped: " << (kShared / name).string() << " is missing");
  return false;
}

struct Found {
  std::string model;
  std::uint64_t packets = 0;
  std::uint64_t scans = 0;
  std::uint64_t points = 0;
  std::uint64_t imu = 0;
  std::uint64_t pressure = 0;
  std::uint64_t clouds = 0;
  double accel_m_s2 = 0.0;
  double pressure_pa = 0.0;
};

/// Imports a source, and decodes the packets of the recording.
Found import_of(const std::filesystem::path& source, ImportRequest request = {}) {
  const TemporaryFolder folder;
  request.source = source;
  request.out = folder.path() / "r";
  import_source(request, [](double) {});
  recording::RecordingReader reader(request.out);
  Found found;
  std::unique_ptr<ScanAssembler> assembler;
  if (reader.manifest().lidar) {
    found.model = reader.manifest().lidar->model;
    LidarConfig config;
    config.model = found.model;
    config.calibration_file = reader.manifest().lidar->calibration_file;
    if (!reader.manifest().lidar->holds_clouds()) {
      assembler = std::make_unique<ScanAssembler>(make_lidar_decoder(config));
    }
  }
  const auto scan = std::make_unique<Scan>();
  recording::Event event;
  while (reader.next(event)) {
    if (event.kind == recording::EventKind::kLidarPacket) {
      ++found.packets;
      (void)assembler->add_packet(event.packet, event.stamp_ns, *scan);
    }
    found.clouds += event.kind == recording::EventKind::kCloud ? 1 : 0;
    if (event.kind == recording::EventKind::kImu && ++found.imu > 0)
      found.accel_m_s2 = event.imu.accel_m_s2.norm();
    if (event.kind == recording::EventKind::kPressure && ++found.pressure > 0) {
      found.pressure_pa = event.pressure.pressure_pa;
    }
  }
  if (assembler) {
    (void)assembler->flush(*scan);
    found.scans = assembler->counters().scans;
    found.points = assembler->counters().returns;
  }
  return found;
}

}  // namespace

TEST_CASE("the packets in rosbag2 files of nebula tell their lidar, and decode") {
  if (!is_there("vlp16-dual-return") || !is_there("hesai-xt16") || !is_there("robosense-helios16")) return;
  const Found velodyne = import_of(kShared / "vlp16-dual-return");
  CHECK(velodyne.model == "VLP-16");
  CHECK(velodyne.packets == 603);
  CHECK(velodyne.points > 50'000);
  const Found hesai = import_of(kShared / "hesai-xt16");
  CHECK(hesai.model == "XT16");
  CHECK(hesai.scans >= 3);
  CHECK(hesai.points > 60'000);
  // The metadata of this bag names a file that is not there; the folder holds another one.
  const Found robosense = import_of(kShared / "robosense-helios16");
  CHECK(robosense.model == "Helios-16P");
  CHECK(robosense.scans >= 3);
}

TEST_CASE("captures tell port and model; an Ouster's takes the metadata of its name") {
  if (!is_there("velodyne-small") || !is_there("ouster")) return;
  CHECK(import_of(kShared / "velodyne-small/vlp16_single_data.pcap").model == "VLP-16");
  // Its product id says HDL-32E, its firing pattern VLP-16.
  CHECK(import_of(kShared / "velodyne-small/velodyne_vlp16.pcap").model == "VLP-16");
  const Found ouster = import_of(kShared / "ouster/OS-0-128-U1_v2.3.0_1024x10.pcap");
  CHECK(ouster.model == "OS0");
  CHECK(ouster.points > 1'000);
  const std::string refused =
      message_of([] { (void)import_of(kShared / "velodyne-small/vlp16_single_position.pcap"); });
  CHECK(refused.find("--model: no packets of a lidar that a driver knows, on UDP ports ") == 0);
}

TEST_CASE("a folder of PCD scans asks for its rate, and gives one cloud a file") {
  if (!is_there("vlp16-corridor")) return;
  ImportRequest request;
  request.rate_hz = 10.0;
  CHECK(import_of(kShared / "vlp16-corridor", request).clouds == 11);
}

TEST_CASE("logs of a VN-100 and of an Xsens give their readings") {
  if (!is_there("vn100-serial") || !is_there("xsens-xbus")) return;
  // Neither its packets nor its lines hold a time.
  CHECK(message_of([] {
          (void)import_of(kShared / "vn100-serial/F00294");
        }).find("--rate: the readings of ") == 0);
  ImportRequest request;
  request.rate_hz = 40.0;
  const Found vn100 = import_of(kShared / "vn100-serial/F00294", request);
  CHECK(vn100.imu >= 98);
  CHECK(vn100.accel_m_s2 == doctest::Approx(9.8).epsilon(0.1));
  CHECK(import_of(kShared / "xsens-xbus/5/output.bin").pressure == 48);
  const Found xsens = import_of(kShared / "xsens-xbus/1/output.bin");
  CHECK(xsens.imu == 96);
  CHECK(xsens.accel_m_s2 == doctest::Approx(9.8).epsilon(0.1));
}

}  // namespace isobar::test::test_import_real
