// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/driver.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "daemon/lock_step.hpp"
#include "run/recording/recording_reader.hpp"
#include "simulation/simulate.hpp"
#include "tests/benchmark/driver/cloud_file.hpp"
#include "tests/benchmark/driver/compare.hpp"
#include "tests/benchmark/driver/result.hpp"

namespace isobar::test::test_driver {

namespace {

using namespace isobar;         // NOLINT(google-build-using-namespace)
using namespace isobar::bench;  // NOLINT(google-build-using-namespace)

/// Temporary folder, removed with the test.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("isobar-bench-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Seven seconds: gravity is found immediately; the robot drives in the last three.
DriverOptions short_run() {
  static const Folder folder;  // simulated once
  DriverOptions options;
  options.data = {"stairs-demo"};
  options.data_options.stop_after_s = 7.0;
  options.data_options.cache = folder.path();
  options.repeat = 2;
  return options;
}

class PoseSink : public EstimateSink {
 public:
  void on_pose(const PoseEstimate& pose, const Prior& /*prior*/) override { poses_.push_back(pose); }
  [[nodiscard]] const std::vector<PoseEstimate>& poses() const { return poses_; }

 private:
  std::vector<PoseEstimate> poses_;
};

std::vector<PoseEstimate> replayed(const std::filesystem::path& recording, const StageSettings& settings) {
  PoseSink sink;
  LockStep pipeline(settings, sink);
  recording::RecordingReader reader(recording);
  recording::Event event;
  while (reader.next(event)) pipeline.handle(event);
  pipeline.finish();
  return sink.poses();
}

void write_pcd(const std::filesystem::path& file, const std::string& header,
               const std::vector<float>& numbers) {
  std::ofstream stream(file, std::ios::binary);
  stream << header;
  stream.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size() * sizeof(float)));
}

}  // namespace

TEST_CASE("a run on a simulated recording gives every figure, and registration allocates nothing") {
  const Json result = run_benchmark(short_run());
  const Json& data = result.at("data").at(0);
  const double scans = data.at("scans");
  CHECK(scans >= 68.0);  // ten a second; the first and the last revolution may be cut
  CHECK(data.at("registered").get<double>() > 0.5 * scans);
  for (const char* row :
       {"decode", "deskew", "sample", "match", "solve", "registration", "map update, where taken",
        "map update, every scan", "snapshot hand-over", "registration + map"}) {
    CAPTURE(row);
    const Json& figures = data.at("ms").at(row);
    CHECK(figures.at("median") > 0.0);
    CHECK(figures.at("p99") >= figures.at("p90"));
    CHECK(figures.at("max") >= figures.at("p99"));
  }
  CHECK(data.at("allocations").at("registration").at("max") == 0.0);
  CHECK(data.at("allocations").at("map").at("max") > 0.0);  // the counter works
  CHECK(data.at("memory").at("end_bytes") > 1e6);
  CHECK(data.at("memory").at("cells") > 100);
  CHECK(data.at("growth").at("mean_ratio") > 0.0);
  for (const auto& item : data.at("counters").items()) {
    const std::string& key = item.key();
    const Json& row = item.value();
    CAPTURE(key);
    CHECK((row.is_string() || row.at("max") > 1e3));  // or the reason why the counter is missing
  }
  // Seven seconds are too short for drift: a larger error means wrong inputs from the driver.
  CHECK(data.at("error").at("final_m") < 0.3);
  CHECK(data.at("peers").is_string());  // instead of figures the reason: built without PCL
  print_tables(result);
}

TEST_CASE("the poses of the driver are bit-identical to those of a replay") {
  const DriverOptions options = short_run();
  const auto data = open_data_set("stairs-demo", options.data_options);
  const Pass pass = measure_pass(*data, false);
  const std::vector<PoseEstimate> poses =
      replayed(options.data_options.cache / data->name(), data->settings());
  std::size_t compared = 0;
  for (const PoseEstimate& pose : poses) {
    for (const evaluation::StampedPose& measured : pass.poses) {
      if (measured.stamp_ns != pose.stamp_ns) continue;
      CHECK(measured.position_m == pose.T_map_base.translation());
      ++compared;
    }
  }
  // The first scan may be older than every prior: a replay emits no pose for it.
  CHECK(compared + 1 >= pass.poses.size());
  CHECK(compared > 60);
}

TEST_CASE("two results are compared figure by figure, in pairs") {
  const Folder folder;
  const auto write = [&](const char* name, double factor) {
    Json row = quantiles_json({1.0 * factor, 2.0 * factor, 3.0 * factor});
    const Json result{{"data",
                       {{{"name", "x"},
                         {"ms", {{"registration", row}}},
                         {"counters", {{"instructions, map", "not allowed"}}},
                         {"allocations", Json::object()},
                         {"growth", {{"mean_ratio", 1.0}}},
                         {"memory", {{"end_bytes", 10}, {"cells", 0}}},
                         {"error", nullptr}}}}};
    const std::filesystem::path file = folder.path() / name;
    std::ofstream(file) << result.dump();
    return file.string();
  };
  const std::string slow = write("slow.json", 2.0);
  const std::string fast = write("fast.json", 0.5);
  const Json ratios = compare_results({slow, slow}, {fast, slow});
  const Json& first = ratios.at(0).at("figures").at(0);
  CHECK(first.at("figure") == "registration, median ms");
  CHECK(first.at("ratio") == doctest::Approx(0.625));  // of 1/4 and 1
  CHECK(first.at("smallest") == doctest::Approx(0.25));
  CHECK_THROWS_AS(compare_results({slow}, {fast, slow}), UsageError);
  CHECK_THROWS_AS(compare_results({slow}, {(folder.path() / "none.json").string()}), DataError);
}

TEST_CASE("a PCD file is read according to its header, and a broken one is refused with the rule") {
  const Folder folder;
  const auto scan = std::make_unique<Scan>();
  const std::filesystem::path good = folder.path() / "10.pcd";
  write_pcd(good, "FIELDS i x y z\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 2 1 1 1\nPOINTS 2\nDATA binary\n",
            {9, 9, 1, 2, 3, 9, 9, std::numeric_limits<float>::quiet_NaN(), 0, 0});
  read_cloud(good, *scan);
  REQUIRE(scan->point_count == 1);
  CHECK(scan->points[0].x_m == 1.0F);
  CHECK(scan->points[0].z_m == 3.0F);

  const std::filesystem::path kitti = folder.path() / "9.bin";
  write_pcd(kitti, "", {4, 5, 6, 0.5F});
  read_cloud(kitti, *scan);
  CHECK(scan->points[0].y_m == 5.0F);
  CHECK(cloud_files(folder.path()) == std::vector<std::filesystem::path>{kitti, good});

  const std::filesystem::path bad = folder.path() / "bad.pcd";
  write_pcd(bad, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n", {});
  CHECK_THROWS_WITH_AS(read_cloud(bad, *scan), doctest::Contains("DATA"), DataError);
  write_pcd(bad, "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA binary\n", {1, 2, 3});
  CHECK_THROWS_WITH_AS(read_cloud(bad, *scan), doctest::Contains("2 points"), DataError);
  write_pcd(bad, "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA binary\n", {1, 2});
  CHECK_THROWS_WITH_AS(read_cloud(bad, *scan), doctest::Contains("FIELDS"), DataError);
}

}  // namespace isobar::test::test_driver
