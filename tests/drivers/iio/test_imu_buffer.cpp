// SPDX-License-Identifier: BSD-3-Clause
// An IMU of the kernel's industrial I/O, on an imitation of its folder in sysfs and a pipe in place of its
// buffer.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "drivers/iio/imu_buffer.hpp"
#include "tests/drivers/serial/imu_bench.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_imu_buffer {

namespace fs = std::filesystem;

namespace {

constexpr double kGyroScale = 0.001;
constexpr double kAccelScale = 0.002394;

/// A BMI160 with a magnetometer's channel that others have switched on.
class Bmi160 {
 public:
  Bmi160() {
    fs::create_directories(path("scan_elements"));
    fs::create_directories(path("buffer"));
    fs::create_directories(path("trigger"));
    for (const char* file : {"buffer/enable", "buffer/length", "buffer/watermark"}) put(file, "0");
    put("sampling_frequency", "1600.000000");
    put("current_timestamp_clock", "realtime");
    put("trigger/current_trigger", "");
    put("in_anglvel_scale", std::to_string(kGyroScale));
    put("in_accel_scale", std::to_string(kAccelScale));
    int index = 0;
    for (const char* channel :
         {"in_anglvel_x", "in_anglvel_y", "in_anglvel_z", "in_accel_x", "in_accel_y", "in_accel_z"}) {
      add_channel(channel, index++, "le:s16/16>>0");
    }
    add_channel("in_timestamp", 9, "le:s64/64>>0");
    add_channel("in_magn_x", 10, "le:s16/16>>0");
    put("scan_elements/in_magn_x_en", "1");
    plug();
  }
  ~Bmi160() { unplug(); }
  Bmi160(const Bmi160&) = delete;
  Bmi160& operator=(const Bmi160&) = delete;

  void plug() {
    mkfifo(path("device").c_str(), 0600);
    pipe_ = open(path("device").c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  void unplug() {
    if (pipe_ >= 0) close(pipe_);
    pipe_ = -1;
    fs::remove(path("device"));
  }
  void put(const std::string& file, const std::string& text) const {
    std::ofstream(path(file)) << text << "\n";
  }
  [[nodiscard]] std::string get(const std::string& file) const {
    std::ifstream in(path(file));
    std::string text;
    std::getline(in, text);
    return text;
  }
  void remove(const std::string& file) const { fs::remove(path(file)); }
  void send(std::int16_t gyro_z, std::int64_t time_ns) const {
    const std::array<std::int16_t, 6> values{10, -20, gyro_z, 0, 0, 4096};
    // Of a single sensor: three values in eight bytes, the stamp behind. The accelerometer has the last three.
    const bool is_accel = is_single_ && !fs::exists(path("in_anglvel_scale"));
    std::array<std::uint8_t, 24> scan{};
    if (is_single_) {
      const std::array<std::int16_t, 3> rates{values[0], values[1], values[2]};
      const std::array<std::int16_t, 3> accelerations{values[3], values[4], values[5]};
      std::memcpy(scan.data(), is_accel ? accelerations.data() : rates.data(), sizeof rates);
    } else {
      std::memcpy(scan.data(), values.data(), sizeof values);
    }
    std::memcpy(scan.data() + (is_single_ ? 8 : 16), &time_ns, sizeof time_ns);
    [[maybe_unused]] const ssize_t count = write(pipe_, scan.data(), is_single_ ? 16 : 24);
  }
  /// Sends at 200 Hz while the buffer is on.
  void serve(std::int64_t now_ns) {
    if (pipe_ < 0 || get("buffer/enable") != "1") {
      next_ns_ = now_ns + phase_ns;
      return;
    }
    for (; sends && now_ns >= next_ns_; next_ns_ += 5'000'000) send(++count_, next_ns_ - 1'000'000'000'000);
  }
  [[nodiscard]] std::string path(const std::string& file) const { return (folder_.path() / file).string(); }
  [[nodiscard]] iio::ImuBufferSettings settings() const {
    return {folder_.path().string(), path("device"), "", 200, "", ""};
  }

  /// Leaves a device of one sensor: "anglvel" or "accel".
  void keep_only(const std::string& kind) {
    for (const char* axis : {"x", "y", "z"}) {
      const std::string other = kind == "accel" ? "anglvel" : "accel";
      for (const char* file : {"_en", "_index", "_type"})
        remove("scan_elements/in_" + other + "_" + axis + file);
    }
    remove(kind == "accel" ? "in_anglvel_scale" : "in_accel_scale");
    is_single_ = true;
  }

  bool sends = true;
  std::int64_t phase_ns = 0;  ///< of its measurements, before the first

 private:
  void add_channel(const std::string& name, int index, const std::string& type) const {
    put("scan_elements/" + name + "_en", "0");
    put("scan_elements/" + name + "_index", std::to_string(index));
    put("scan_elements/" + name + "_type", type);
  }

  TemporaryFolder folder_;
  bool is_single_ = false;
  int pipe_ = -1;
  std::int16_t count_ = 0;
  std::int64_t next_ns_ = 0;
};

struct Robot {
  explicit Robot(iio::ImuBufferSettings settings = {}) {
    const std::string trigger = settings.trigger;
    settings = sensor->settings();
    settings.trigger = trigger;
    bench = std::make_unique<ImuBench>(std::make_unique<iio::ImuBuffer>(settings),
                                       [this](std::int64_t now_ns) { sensor->serve(now_ns); });
  }
  std::unique_ptr<Bmi160> sensor = std::make_unique<Bmi160>();
  std::unique_ptr<ImuBench> bench;
};

}  // namespace

TEST_CASE("the buffer is set up and its scans become samples in SI units, stamped by the kernel") {
  iio::ImuBufferSettings settings;
  settings.trigger = "bmi160-dev0";
  Robot robot(settings);
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  CHECK(robot.sensor->get("sampling_frequency") == "200");
  CHECK(robot.sensor->get("current_timestamp_clock") == "monotonic");
  CHECK(robot.sensor->get("trigger/current_trigger") == "bmi160-dev0");
  CHECK(robot.sensor->get("buffer/enable") == "1");
  CHECK(robot.sensor->get("scan_elements/in_accel_z_en") == "1");
  CHECK(robot.sensor->get("scan_elements/in_timestamp_en") == "1");
  CHECK(robot.sensor->get("scan_elements/in_magn_x_en") == "0");
  robot.bench->run(0.3);
  const auto& samples = robot.bench->samples;
  REQUIRE(samples.size() > 50);
  CHECK(samples[0].has_imu);
  CHECK_FALSE(samples[0].has_pressure);
  CHECK(samples[0].imu.accel_m_s2.z() == doctest::Approx(4096 * kAccelScale));
  CHECK(samples[0].imu.gyro_rad_s.y() == doctest::Approx(-20 * kGyroScale));
  const auto irregular =
      std::count_if(samples.begin() + 1, samples.end(), [](const InertialReading& reading) {
        const InertialReading& before = *(&reading - 1);
        return std::abs(reading.imu.stamp_ns - before.imu.stamp_ns - 5'000'000) > 500'000;
      });
  CHECK(irregular < 6);
  CHECK(samples.back().imu.stamp_ns < monotonic_ns());
  CHECK(samples.back().imu.stamp_ns > monotonic_ns() - 50'000'000);
}

TEST_CASE("an offset and a scale of one axis are used, and a missing time stamp is said") {
  Robot robot;
  robot.sensor->put("in_accel_z_scale", "0.01");
  robot.sensor->put("in_accel_offset", "-96");
  robot.sensor->remove("scan_elements/in_timestamp_type");
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  CHECK(std::string(robot.bench->device->status().note.data()).find("no time stamps") != std::string::npos);
  CHECK(robot.bench->samples[0].imu.accel_m_s2.z() == doctest::Approx(40.0));
  CHECK(robot.bench->samples[0].imu.accel_m_s2.x() == doctest::Approx(-96 * kAccelScale));
}

TEST_CASE("accelerometer and gyro in two devices are one IMU, whatever the phase between them") {
  Bmi160 gyro;
  Bmi160 accel;
  gyro.keep_only("anglvel");
  accel.keep_only("accel");
  accel.phase_ns = 2'000'000;
  iio::ImuBufferSettings settings = gyro.settings();
  settings.accel_folder = accel.settings().folder;
  settings.accel_device = accel.settings().device;
  ImuBench bench(std::make_unique<iio::ImuBuffer>(settings), [&](std::int64_t now_ns) {
    gyro.serve(now_ns);
    accel.serve(now_ns);
  });
  REQUIRE(bench.run_until_state(0.5, DeviceState::kMeasuring));
  bench.samples.clear();
  bench.run(0.3);
  REQUIRE(bench.samples.size() > 40);
  CHECK(bench.samples[0].imu.accel_m_s2.z() == doctest::Approx(4096 * kAccelScale));
  CHECK(bench.samples[0].imu.gyro_rad_s.y() == doctest::Approx(-20 * kGyroScale));
  CHECK(bench.samples.back().imu.stamp_ns > monotonic_ns() - 50'000'000);
  // The accelerometer alone vanishes: said at once, and both are back.
  accel.unplug();
  REQUIRE(bench.run_until_state(0.2, DeviceState::kNoAnswer));
  bench.run(0.1);
  CHECK(bench.fault() == "accelerometer: the buffer cannot be opened (No such file or directory)");
  accel.plug();
  CHECK(bench.run_until_state(2.0, DeviceState::kMeasuring));
}

TEST_CASE("two devices that are no gyro, no accelerometer, or without time stamps are refused by name") {
  const auto fault_of = [](const char* main_kind, const char* other_kind, const char* removed) {
    Bmi160 main;
    Bmi160 other;
    main.keep_only(main_kind);
    other.keep_only(other_kind);
    if (removed != nullptr) other.remove(removed);
    iio::ImuBufferSettings settings = main.settings();
    settings.accel_folder = other.settings().folder;
    settings.accel_device = other.settings().device;
    ImuBench bench(std::make_unique<iio::ImuBuffer>(settings), [](std::int64_t /*now_ns*/) {});
    bench.run(0.02);
    return bench.fault();
  };
  CHECK(fault_of("anglvel", "anglvel", nullptr) == "accelerometer: it has no accelerometer");
  CHECK(fault_of("accel", "accel", nullptr) == "it has no gyro");
  CHECK(fault_of("anglvel", "accel", "scan_elements/in_timestamp_type") ==
        "two devices cannot be paired without time stamps");
}

TEST_CASE("what the device lacks is said by name") {
  const auto fault_without = [](const std::string& file) {
    Robot robot;
    robot.sensor->remove(file);
    robot.bench->run(0.02);
    return robot.bench->fault();
  };
  CHECK(fault_without("buffer/enable") == "no such device, or it has no buffer (No such file or directory)");
  CHECK(fault_without("scan_elements/in_accel_x_type") ==
        "it has not both accelerometer and gyro: set imu.iio.accel_folder");
  CHECK(fault_without("in_accel_scale") == "it has no scale (No such file or directory)");
  CHECK(fault_without("device") == "the buffer cannot be opened (No such file or directory)");
  CHECK(fault_without("sampling_frequency") == "");  // its trigger's rate
  Robot odd;
  odd.sensor->put("scan_elements/in_accel_x_type", "le:f32/32>>0");
  odd.bench->run(0.02);
  CHECK(odd.bench->fault() == "a channel of an unknown type");
}

TEST_CASE("a device that vanishes is said within 0.2 s, and measures within 2 s of its return") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  robot.bench->run(0.1);
  robot.sensor->unplug();
  REQUIRE(robot.bench->run_until_state(0.2, DeviceState::kNoAnswer));
  CHECK(robot.bench->fault().starts_with("unplugged"));
  robot.bench->run(0.3);
  robot.sensor->plug();
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
}

TEST_CASE("a buffer without scans is silent within 0.2 s and is set up anew") {
  Robot robot;
  REQUIRE(robot.bench->run_until_state(0.5, DeviceState::kMeasuring));
  robot.bench->run(0.1);
  robot.sensor->sends = false;
  REQUIRE(robot.bench->run_until_state(0.2, DeviceState::kSilent));
  CHECK(robot.sensor->get("buffer/enable") == "0");
  robot.sensor->sends = true;
  CHECK(robot.bench->run_until_state(2.0, DeviceState::kMeasuring));
}

}  // namespace isobar::test::test_imu_buffer
