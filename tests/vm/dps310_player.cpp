// SPDX-License-Identifier: BSD-3-Clause
// Emulates a DPS310 on the kernel's i2c-stub, a bus of plain memory: runs the model of the chip, passes it
// the driver's writes, and writes its registers to the bus. Usage: dps310_player BUS {play|brownout|freeze
// SECONDS}…
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "drivers/bus/smbus.hpp"
#include "tests/drivers/dps310/chip_model.hpp"

using namespace isobar;
using namespace isobar::dps310;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace {

constexpr std::uint8_t kReady = kPressureReady | kTemperatureReady;
/// i2c-stub reports no reads: a result counts as read after one and a half polls of the driver.
constexpr auto kReadWithin = 12ms;

class Player {
 public:
  explicit Player(const char* bus) : stub_(bus, 0x77) {
    check(stub_.open(), "open");
    chip_.noise_pa = 0.35;
    clear();
  }

  void run(std::chrono::seconds duration) {
    const auto end = Clock::now() + duration;
    while (Clock::now() < end) {
      tick();
      std::this_thread::sleep_for(1ms);
    }
  }
  void brownout() {
    chip_.power_up();
    clear();
  }
  void freeze() { chip_.frozen = true; }

 private:
  static void check(int error, const char* what) {
    if (error == 0) return;
    std::fprintf(stderr, "dps310_player: %s: %s\n", what, std::strerror(error));
    std::exit(1);
  }
  std::uint8_t get(std::uint8_t address) {
    std::uint8_t value = 0;
    check(stub_.read(address, {&value, 1}), "read");
    return value;
  }
  void put(std::uint8_t address, std::uint8_t value) { check(stub_.write(address, value), "write"); }

  /// The registers after power-up.
  void clear() {
    for (const std::uint8_t address :
         {kReset, kMeasurementConfig, kPressureConfig, kTemperatureConfig, kConfig}) {
      put(address, 0);
    }
    put(kProductId, chip_.id);
    put(kCoefficientSource, kExternalThermometer);
    for (std::size_t i = 0; i < kCoefficientBytes; ++i) {
      put(static_cast<std::uint8_t>(kCoefficients + i), dps310::kKnownBytes[i]);
    }
    shown_ = 0;
  }

  void tick() {
    chip_.run_until(start_ns_ + (Clock::now() - start_).count());
    if (get(kReset) == kSoftReset) {
      (void)chip_.write(kReset, kSoftReset);
      clear();
    }
    for (const std::uint8_t address : {kPressureConfig, kTemperatureConfig, kConfig}) {
      if (const std::uint8_t value = get(address); value != chip_.held(address))
        (void)chip_.write(address, value);
    }
    const std::uint8_t held = get(kMeasurementConfig);
    if ((held & kModeMask) != (shown_ & kModeMask)) (void)chip_.write(kMeasurementConfig, held & kModeMask);
    show(held);
  }

  void show(std::uint8_t held) {
    std::uint8_t status = 0;  // a chip in reset does not answer
    if (chip_.read(kMeasurementConfig, {&status, 1}) != 0) return;
    if ((status & kReady & ~shown_) != 0) {
      // Clear the ready bits first and let a read in progress end: no torn result.
      put(kMeasurementConfig, static_cast<std::uint8_t>(status & ~kReady));
      std::this_thread::sleep_for(2ms);
      for (std::uint8_t address = 0; address < kResultBytes; ++address) put(address, chip_.held(address));
      put(kMeasurementConfig, status);
      shown_at_ = Clock::now();
    } else if (status != held) {
      put(kMeasurementConfig, status);
    }
    shown_ = status;
    if ((status & kReady) != 0 && Clock::now() - shown_at_ > kReadWithin) {
      std::array<std::uint8_t, kResultBytes> bytes{};
      (void)chip_.read(kPressureResult, bytes);
    }
  }

  SmbusDevice stub_;
  dps310::ChipModel chip_;
  std::int64_t start_ns_ = chip_.now_ns();
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_at_ = Clock::now();
  std::uint8_t shown_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 4 || count % 2 != 0) {
    std::fprintf(stderr, "usage: dps310_player BUS {play|brownout|freeze SECONDS}...\n");
    return 64;
  }
  Player player(arguments[1]);
  for (int i = 2; i < count; i += 2) {
    const std::string what = arguments[i];
    if (what == "brownout") player.brownout();
    if (what == "freeze") player.freeze();
    player.run(std::chrono::seconds(std::atoi(arguments[i + 1])));
  }
  return 0;
}
