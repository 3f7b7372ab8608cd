// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <fstream>

#include "core/errors.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/import/import_source.hpp"

namespace isobar::test::test_import_files {
namespace {

using namespace tools;

void write_kitti_scan(const std::filesystem::path& file, float x) {
  std::ofstream out(file, std::ios::binary);
  for (int i = 0; i < 20; ++i) {
    for (const float value : {x, static_cast<float>(i), 1.0F, 0.5F}) {
      out.write(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
}

std::vector<std::int64_t> cloud_stamps(const std::filesystem::path& folder) {
  recording::RecordingReader reader(folder);
  recording::Event event;
  std::vector<std::int64_t> stamps;
  while (reader.next(event)) {
    if (event.kind == recording::EventKind::kCloud) stamps.push_back(event.stamp_ns);
  }
  return stamps;
}

}  // namespace

TEST_CASE("a KITTI sequence takes its times from times.txt, and scans in the order of their numbers") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "00" / "velodyne");
  for (const char* name : {"2.bin", "10.bin", "1.bin"}) {
    write_kitti_scan(folder.path() / "00" / "velodyne" / name, static_cast<float>(std::atoi(name)));
  }
  std::ofstream(folder.path() / "00" / "times.txt") << "0.000000e+00\n1.036224e-01\n2.072830e-01\n";
  ImportRequest request{.source = folder.path() / "00", .out = folder.path() / "r"};
  import_source(request, [](double) {});
  CHECK(cloud_stamps(request.out) == std::vector<std::int64_t>{0, 103'622'400, 207'283'000});
  recording::RecordingReader reader(request.out);
  recording::Event event;
  std::vector<float> first_x;
  while (reader.next(event)) {
    first_x.push_back(*reinterpret_cast<const float*>(event.cloud->data.data()));
  }
  CHECK(first_x == std::vector<float>{1.0F, 2.0F, 10.0F});
}

TEST_CASE("scans without times count 10 a second, or --rate; a broken one is left out and said") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "scans");
  for (int i = 0; i < 3; ++i) {
    std::ofstream(folder.path() / "scans" / (std::to_string(i) + ".pcd"))
        << "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"
        << (i == 1 ? "broken\n" : "1 2 3\n");
  }
  ImportRequest request{.source = folder.path() / "scans", .out = folder.path() / "r"};
  // Beside other logs a guess would be wrong: it is asked for.
  request.imu = folder.path() / "imu.csv";
  std::ofstream(request.imu) << "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n0,0,0,0,0,0,9.8\n";
  CHECK(message_of([&] { import_source(request, [](double) {}); }).find("--rate: neither a times.txt") == 0);
  CHECK_FALSE(std::filesystem::exists(request.out));
  request.imu.clear();
  const ImportReport assumed = import_source(request, [](double) {});
  CHECK(cloud_stamps(request.out) == std::vector<std::int64_t>{0, 200'000'000});
  CHECK(assumed.notes.back().find("10 a second are assumed") != std::string::npos);
  request.out = folder.path() / "by-rate";
  request.rate_hz = 5.0;
  const ImportReport report = import_source(request, [](double) {});
  CHECK(cloud_stamps(request.out) == std::vector<std::int64_t>{0, 400'000'000});
  CHECK(report.notes[1].find("1 files are left out") == 0);
}

TEST_CASE("logs beside scans become the IMU and the barometer; their mount and clock are asked for") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "scans");
  for (int i = 0; i < 2; ++i) {
    std::ofstream(folder.path() / "scans" / ("170000000" + std::to_string(i) + ".ply"))
        << "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
           "z\nend_header\n1 2 "
           "3\n";
  }
  std::ofstream imu(folder.path() / "imu.csv");
  imu << "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  for (int i = 0; i < 10; ++i) imu << 100'000'000 * i << ",0,0,0,0,0,9.8\n";
  imu.close();
  std::ofstream baro(folder.path() / "baro.csv");
  baro << "t_ns,pressure_hPa\n";
  for (int i = 0; i < 10; ++i)
    baro << 1'700'000'000'000'000'000 + 100'000'000 * i << ',' << 1000.0 + 0.1 * i << '\n';
  baro.close();
  ImportRequest request{.source = folder.path() / "scans", .out = folder.path() / "r"};
  request.imu = folder.path() / "imu.csv";
  request.pressure = folder.path() / "baro.csv";
  const auto refusal = [&] { return message_of([&] { import_source(request, [](double) {}); }); };
  CHECK(refusal().find("--log-offset: ") == 0);
  request.log_offset_s = 0.5;
  CHECK(refusal().find("--mount: how the IMU of ") == 0);
  request.mount_texts = {"imu=0,0,0.1,0,0,0"};
  import_source(request, [](double) {});
  recording::RecordingReader reader(request.out);
  recording::Event event;
  std::int64_t first_imu_ns = 0;
  double first_pa = 0.0;
  while (reader.next(event)) {
    if (event.kind == recording::EventKind::kImu && first_imu_ns == 0) first_imu_ns = event.stamp_ns;
    if (event.kind == recording::EventKind::kPressure && first_pa == 0.0)
      first_pa = event.pressure.pressure_pa;
  }
  CHECK(first_imu_ns == 1'700'000'000'500'000'000);
  CHECK(first_pa == 100'000.0);
}

TEST_CASE("what is nothing that is read is refused, with what would be") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "x.txt") << "some text";
  const auto refusal = [&](const std::filesystem::path& source) {
    return message_of([&] { import_source({.source = source, .out = folder.path() / "r"}, [](double) {}); });
  };
  CHECK(refusal(folder.path() / "x.txt").find("x.txt: is text, beginning with \"some text\"; a log ") !=
        std::string::npos);
  std::ofstream(folder.path() / "empty.bag").flush();
  CHECK(refusal(folder.path() / "empty.bag").find("empty.bag: is empty") != std::string::npos);
  std::ofstream(folder.path() / "a.bag") << "PK\x03\x04" << std::string(40, '\0');
  CHECK(refusal(folder.path() / "a.bag").find("a.bag: is a zip archive; unpack it first") !=
        std::string::npos);
  std::ofstream(folder.path() / "b.bag") << std::string(40, '\1');
  CHECK(
      refusal(folder.path() / "b.bag").find("b.bag: begins with bytes of no format that is known; rosbag1") !=
      std::string::npos);
  std::filesystem::create_directory(folder.path() / "logs");
  std::ofstream(folder.path() / "logs" / "a.csv") << "a,b";
  CHECK(refusal(folder.path() / "logs").find("it holds a.csv") != std::string::npos);
  CHECK(refusal(folder.path() / "gone").find("gone: no such file or folder") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r"));
}

}  // namespace isobar::test::test_import_files
