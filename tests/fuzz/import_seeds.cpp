// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/import_seeds.hpp"

#include "tests/run/import/bag_builder.hpp"
#include "tests/run/import/message_builder.hpp"

namespace isobar::test {

void write_import_seeds(const std::filesystem::path& root) {
  const std::filesystem::path folder = root / "fuzz_import";
  std::filesystem::create_directories(folder);
  const std::vector<BagTopic> topics{{"/imu", "sensor_msgs/Imu"}, {"/points", "sensor_msgs/PointCloud2"}};
  for (const Form form : {Form::kRos1, Form::kCdrLittle}) {
    const std::string imu =
        imu_message(form, 1'700'000'000'000'000'000, "imu", {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 9.8});
    const std::string cloud =
        cloud_message(form, 1'700'000'000'000'000'000, "lidar", {{1, 2, 3, 0, 1}, {2, 3, 4, 0.1F, 2}});
    const std::string frames = transform_message(form, "base_link", "lidar", {0, 0, 1, 0, 0, 0, 1});
    const std::vector<BagMessage> messages{{0, 1, imu}, {1, 2, cloud}, {0, 3, imu}};
    const bool is_ros1 = form == Form::kRos1;
    const std::string name = is_ros1 ? "ros1" : "cdr";
    for (const std::string& bytes : {imu, cloud, frames}) {
      write_bytes(folder / (name + std::to_string(bytes.size())),
                  std::string(1, is_ros1 ? '\4' : '\5') + bytes);
    }
    for (const std::string method : {"none", "lz4", "zstd"}) {
      write_bytes(folder / ("mcap_" + name + method), mcap_file(topics, messages, method, name));
    }
    for (const std::string method : {"none", "lz4", "bz2"}) {
      write_bytes(folder / ("rosbag1_" + method), rosbag1_file(topics, messages, method));
    }
  }
  write_bytes(folder / "pcd", std::string(1, '\0') +
                                  "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
                                  "POINTS 1\nDATA ascii\n1 2 3\n");
  write_bytes(folder / "ply", std::string(1, '\1') +
                                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                  "end_header\n1\n");
}

}  // namespace isobar::test
