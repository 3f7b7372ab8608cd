// SPDX-License-Identifier: BSD-3-Clause
// Emulates a BMP581, BMP390, ICP-20100 or MS5611 on the kernel's i2c-stub, a bus of plain memory: runs the model of
// the chip, passes it the driver's writes, and writes its registers to the bus. i2c-stub reports no reads: a result
// counts as read after one and a half polls of the driver. Of the MS5611, whose commands leave no trace there, only
// the memory and one constant result can be shown.
// Usage: barometer_player BUS {bmp581|bmp390|icp20100|ms5611} {play|brownout|freeze SECONDS}…
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/bus/smbus.hpp"
#include "tests/drivers/bmp390/chip_model.hpp"
#include "tests/drivers/bmp581/chip_model.hpp"
#include "tests/drivers/icp20100/chip_model.hpp"
#include "tests/drivers/ms5611/known_sensor.hpp"

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

namespace {

using namespace isobar;

constexpr auto kReadWithin = 7ms;

class Stub {
 public:
  Stub(const char* bus, std::uint8_t address) : device_(bus, address) { check(device_.open(), "open"); }
  std::uint8_t get(std::uint8_t address) {
    std::uint8_t value = 0;
    check(device_.read(address, {&value, 1}), "read");
    return value;
  }
  void put(unsigned address, unsigned value) {
    check(device_.write(static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(value)), "write");
  }

 private:
  static void check(int error, const char* what) {
    if (error == 0) return;
    std::fprintf(stderr, "barometer_player: %s: %s\n", what, std::strerror(error));
    std::exit(1);
  }
  SmbusDevice device_;
};

/// Registers of a chip: where the driver writes and where it reads.
struct Layout {
  std::uint8_t address;                 ///< I2C
  std::vector<std::uint8_t> constants;  ///< only read by the driver
  std::vector<std::uint8_t> settings;   ///< written by the driver
  std::uint8_t command;                 ///< register of a reset (Bosch) or a flush (ICP-20100)
  std::uint8_t command_value;
  std::uint8_t ready;  ///< register that tells of a result
  std::uint8_t ready_mask;
  std::uint8_t idle;  ///< its other bits
  std::uint8_t data;  ///< 6 bytes
};

/// A chip of registers and its player.
class Player {
 public:
  Player(const char* bus, Layout layout, std::unique_ptr<test::BarometerModel> chip)
      : layout_(std::move(layout)), stub_(bus, layout_.address), chip_(std::move(chip)) {
    chip_->noise_pa = 0.3;
    clear();
  }
  void run(std::chrono::seconds duration) {
    const auto end = Clock::now() + duration;
    while (Clock::now() < end) {
      chip_->run_until(start_ns_ + (Clock::now() - start_).count());
      tick();
      std::this_thread::sleep_for(1ms);
    }
  }
  void brownout() {
    chip_->power_up();
    clear();
  }
  void freeze() { chip_->frozen = true; }

 private:
  std::uint8_t held(std::uint8_t address) {
    std::uint8_t value = 0;
    (void)chip_->read(address, {&value, 1});
    return value;
  }
  /// Shows the registers after power-up.
  void clear() {
    chip_->run_until(chip_->now_ns() + 5'000'000);  // until it answers
    start_ns_ = chip_->now_ns();
    start_ = Clock::now();
    stub_.put(layout_.command, 0);
    for (const std::uint8_t address : layout_.constants) stub_.put(address, held(address));
    for (const std::uint8_t address : layout_.settings) stub_.put(address, held(address));
    stub_.put(layout_.ready, layout_.idle);
    is_shown_ = settled_ = false;
  }
  void tick() {
    for (const std::uint8_t address : layout_.settings) {
      const std::uint8_t value = stub_.get(address);
      if (value != held(address)) (void)chip_->write(address, value);
    }
    if (stub_.get(layout_.command) == layout_.command_value) {
      (void)chip_->write(layout_.command, layout_.command_value);
      if (!is_icp20100()) return clear();
      stub_.put(layout_.command, 0);
      settled_ = is_shown_;  // the driver flushes once before and once after the filter's settling
      is_shown_ = false;
    }
    if (is_shown_ && settled() && Clock::now() - shown_at_ > kReadWithin) {
      stub_.put(layout_.ready, layout_.idle);
      is_shown_ = false;
    }
    if (!is_shown_) show();
  }
  void show() {
    const std::uint8_t status = held(layout_.ready);
    if ((status & layout_.ready_mask) == 0 || (!settled() && (status & layout_.ready_mask) < 14)) return;
    std::this_thread::sleep_for(1ms);  // a read in progress ends
    if (settled()) {
      std::array<std::uint8_t, 6> bytes{};
      if (chip_->read(layout_.data, bytes) != 0) return;
      for (unsigned i = 0; i < bytes.size(); ++i) stub_.put(layout_.data + i, bytes[i]);
      if (is_icp20100()) (void)held(0x00);  // ends the burst
    }
    stub_.put(layout_.ready, is_icp20100() && settled() ? 1U : status);
    shown_at_ = Clock::now();
    is_shown_ = true;
  }
  [[nodiscard]] bool is_icp20100() const { return layout_.data == 0xFA; }
  /// Results are shown one by one; before, the ICP-20100 shows how full its FIFO is.
  [[nodiscard]] bool settled() const { return settled_ || !is_icp20100(); }

  Layout layout_;
  Stub stub_;
  std::unique_ptr<test::BarometerModel> chip_;
  std::int64_t start_ns_ = 0;
  Clock::time_point start_;
  Clock::time_point shown_at_;
  bool is_shown_ = false;
  bool settled_ = false;
};

Player make_player(const char* bus, const std::string& chip) {
  if (chip == "bmp581") {
    return {bus,
            {0x47, {0x01, 0x28, 0x38}, {0x15, 0x30, 0x31, 0x36, 0x37}, 0x7E, 0xB6, 0x27, 0x01, 0x00, 0x1D},
            std::make_unique<bmp581::ChipModel>()};
  }
  if (chip == "bmp390") {
    std::vector<std::uint8_t> constants{0x00};
    for (std::uint8_t address = 0x30; address <= 0x45; ++address) constants.push_back(address);
    return {bus,
            {0x77, constants, {0x1C, 0x1D, 0x1F, 0x1B}, 0x7E, 0xB6, 0x03, 0x60, 0x10, 0x04},
            std::make_unique<bmp390::ChipModel>()};
  }
  return {bus,
          {0x63, {0x0C, 0xCD, 0xD3, 0xBF}, {0xC3, 0xC0}, 0xC4, 0x80, 0xC4, 0x1F, 0x00, 0xFA},
          std::make_unique<icp20100::ChipModel>()};
}

/// The memory of the data sheet's example, and one result for both conversions: 20.07 degrees, 90.1 kPa.
void show_ms5611(const char* bus) {
  Stub stub(bus, 0x77);
  const ms5611::Prom prom = ms5611::sealed(ms5611::kKnownProm);
  for (unsigned word = 0; word < prom.size(); ++word) {
    stub.put(0xA0 + 2 * word, prom[word] >> 8U);
    stub.put(0xA1 + 2 * word, prom[word] & 0xFFU);
  }
  const std::uint32_t result = ms5611::kExampleResult.temperature;
  for (unsigned i = 0; i < 3; ++i) stub.put(i, result >> (16 - 8 * i) & 0xFFU);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3 || count % 2 == 0) {
    std::fprintf(
        stderr,
        "usage: barometer_player BUS {bmp581|bmp390|icp20100|ms5611} {play|brownout|freeze SECONDS}...\n");
    return 64;
  }
  const std::string chip = arguments[2];
  if (chip == "ms5611") {
    show_ms5611(arguments[1]);
    return 0;
  }
  Player player = make_player(arguments[1], chip);
  for (int i = 3; i < count; i += 2) {
    const std::string what = arguments[i];
    if (what == "brownout") player.brownout();
    if (what == "freeze") player.freeze();
    player.run(std::chrono::seconds(std::atoi(arguments[i + 1])));
  }
  return 0;
}
