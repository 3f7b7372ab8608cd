// SPDX-License-Identifier: BSD-3-Clause
// `isobar config init`: what is looked at, and what is proposed.
#include "tools/config_proposal.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "config/config_io.hpp"
#include "drivers/udp/udp.hpp"
#include "tests/drivers/velodyne/packet_builder.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/machine_survey.hpp"

namespace isobar::test::test_config_proposal {

namespace {

namespace fs = std::filesystem;
using tools::identify_barometer;
using tools::proposal;
using tools::Survey;

/// A machine's dev and sys.
class Machine {
 public:
  void add(const std::string& file, const std::string& text = "") const {
    fs::create_directories((root() / file).parent_path());
    std::ofstream(root() / file) << text;
  }
  [[nodiscard]] fs::path root() const { return folder_.path(); }
  [[nodiscard]] Survey survey() const {
    Survey survey;
    survey_devices(root(), survey);
    return survey;
  }

 private:
  TemporaryFolder folder_;
};

std::size_t settings_in(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(" = "); at != std::string::npos; at = text.find(" = ", at + 1)) ++count;
  return count;
}

bool has(const std::string& text, const std::string& words) {
  CAPTURE(text);
  return text.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("a machine with nothing gets a file of ten lines that says what was not found") {
  const std::string text = proposal(Machine().survey());
  CHECK_NOTHROW(parse_config(text, "c.toml"));
  CHECK(settings_in(text) <= 10);
  CHECK(has(text, "# No lidar was heard"));
  CHECK(has(text, "# No barometer was found (I2C buses: none)"));
  CHECK(has(text, "# Serial lines: none. GPIO chips: none."));
}

TEST_CASE("a barometer with a kernel driver is proposed; other devices with a driver are not") {
  const Machine machine;
  machine.add("sys/bus/iio/devices/iio:device0/name", "ads1115\n");
  machine.add("sys/bus/iio/devices/iio:device0/in_voltage0_raw", "1\n");
  machine.add("sys/bus/iio/devices/iio:device1/name", "bmp280\n");
  machine.add("sys/bus/iio/devices/iio:device1/in_pressure_input", "101.3\n");
  const std::string text = proposal(machine.survey());
  const Config config = parse_config(text, "c.toml");
  CHECK(config.barometer.source == BarometerSource::kIio);
  CHECK(fs::path(config.barometer.iio.folder).filename() == "iio:device1");
  CHECK(has(text, "# Found bmp280 with a kernel driver"));
}

TEST_CASE("serial lines that exist and GPIO chips are named; a bus that is none is noted") {
  const Machine machine;
  machine.add("dev/ttyUSB0");
  machine.add("dev/ttyS0");
  machine.add("dev/ttyS1");
  machine.add("sys/class/tty/ttyS1/type", "4\n");
  machine.add("sys/class/tty/ttyS0/type", "0\n");
  machine.add("dev/gpiochip0");
  machine.add("dev/i2c-1");
  const Survey survey = machine.survey();
  CHECK(survey.serial == std::vector<std::string>{(machine.root() / "dev/ttyS1").string(),
                                                  (machine.root() / "dev/ttyUSB0").string()});
  CHECK(survey.gpio.size() == 1);
  CHECK(survey.i2c_buses.size() == 1);
  CHECK(survey.i2c.empty());
  REQUIRE(survey.notes.size() == 1);
  CHECK(has(proposal(survey), "# Not looked at: " + (machine.root() / "dev/i2c-1").string()));
}

TEST_CASE("a barometer at its address is preferred to a kernel driver, other chips are only named") {
  Survey survey;
  survey.i2c = {{"/dev/i2c-0", 0x76, BarometerSource::kNone}, {"/dev/i2c-3", 0x76, BarometerSource::kDps310}};
  survey.iio = {{"/sys/bus/iio/devices/iio:device1", "bmp280"}};
  Config config = parse_config(proposal(survey), "c.toml");
  CHECK(config.barometer.source == BarometerSource::kDps310);
  CHECK(config.barometer.dps310.bus == "/dev/i2c-3");
  CHECK(config.barometer.dps310.address == "0x76");
  CHECK(has(proposal(survey), "# Found: no known barometer at /dev/i2c-0, address 0x76."));
  survey.i2c = {{"/dev/i2c-7", 0x64, BarometerSource::kIcp20100}};
  config = parse_config(proposal(survey), "c.toml");
  CHECK(config.barometer.source == BarometerSource::kIcp20100);
  CHECK(config.barometer.icp20100.bus == "/dev/i2c-7");
  CHECK(config.barometer.icp20100.address == "0x64");
}

TEST_CASE("every barometer that a bus can have is identified, by reads alone, and other bytes are none") {
  class Chip final : public RegisterBus {
   public:
    int open() noexcept override { return 0; }
    int read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept override {
      for (std::uint8_t& byte : bytes) byte = registers[first++];
      return 0;
    }
    int write(std::uint8_t, std::uint8_t) noexcept override {
      ++writes;
      return 0;
    }
    std::array<std::uint8_t, 256> registers{};
    int writes = 0;
  };
  Chip dps310;
  dps310.registers[0x0D] = 0x10;
  CHECK(identify_barometer(dps310, 0x77) == BarometerSource::kDps310);
  CHECK(identify_barometer(dps310, 0x47) == BarometerSource::kNone);  // not its address
  Chip bmp390;
  bmp390.registers[0x00] = 0x60;
  CHECK(identify_barometer(bmp390, 0x76) == BarometerSource::kBmp390);
  Chip bmp581;
  bmp581.registers[0x01] = 0x50;
  CHECK(identify_barometer(bmp581, 0x46) == BarometerSource::kBmp581);
  Chip icp20100;
  icp20100.registers[0x0C] = 0x63;
  CHECK(identify_barometer(icp20100, 0x63) == BarometerSource::kIcp20100);
  Chip ms5611;  // the example of application note AN520
  const std::array<std::uint8_t, 16> prom{0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38,
                                          0x39, 0x40, 0x41, 0x42, 0x43, 0x44, 0x45, 0x0B};
  std::copy(prom.begin(), prom.end(), ms5611.registers.begin() + 0xA0);
  CHECK(identify_barometer(ms5611, 0x77) == BarometerSource::kMs5611);
  Chip none;
  none.registers.fill(0xFF);
  for (int address = 0; address < 128; ++address) {
    CHECK(identify_barometer(none, static_cast<std::uint8_t>(address)) == BarometerSource::kNone);
  }
  CHECK(dps310.writes + bmp390.writes + bmp581.writes + icp20100.writes + ms5611.writes + none.writes == 0);
}

TEST_CASE("a lidar that sends is found with its address, model and rate") {
  Survey survey;
  std::thread sender([] {
    UdpSender out("127.0.0.1", 2368);
    test::PacketPlan plan;
    plan.product_id = 0x28;  // VLP-32C
    const auto packet = test::build_packet(plan);
    for (int i = 0; i < 50; ++i) {
      (void)out.send(packet);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  survey_lidars(0.8, survey);
  sender.join();
  if (survey.lidars.empty() && !survey.notes.empty()) {
    MESSAGE("port 2368 of this machine is in use: " << survey.notes.front());
    return;
  }
  REQUIRE(survey.lidars.size() == 1);
  CHECK(survey.lidars[0].sender == "127.0.0.1");
  CHECK(survey.lidars[0].model == "VLP-32C");
  CHECK(survey.lidars[0].packets_per_s > 10.0);
  const std::string text = proposal(survey);
  CHECK(parse_config(text, "c.toml").lidar.model == "VLP-32C");
  CHECK(has(text, "packets a second from 127.0.0.1 to UDP port 2368"));
}

TEST_CASE("of two lidars the first with a driver is proposed with its address") {
  Survey survey;
  survey.lidars = {{"10.0.0.2", 2368, "", "packets of VLS-128", 1500.0},
                   {"10.0.0.3", 2368, "VLP-16", "", 754.0}};
  CHECK(parse_config(proposal(survey), "c.toml").lidar.sender == "10.0.0.3");
}

TEST_CASE("a lidar without a driver is named by what its packets say, and not proposed") {
  Survey survey;
  survey.lidars = {{"10.0.0.2", 2368, "", "packets of VLS-128", 1500.0}};
  const std::string text = proposal(survey);
  CHECK(has(text,
            "# Found a lidar without a driver (packets of VLS-128): 1500 packets a second from 10.0.0.2"));
  CHECK(parse_config(text, "c.toml").lidar.model == "VLP-16");
}

}  // namespace isobar::test::test_config_proposal
