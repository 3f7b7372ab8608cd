// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/barometer/model.hpp"

#include <algorithm>

namespace isobar::test {

void BarometerModel::run_until(std::int64_t now_ns) {
  for (std::int64_t event_ns = next_event_ns(); event_ns <= now_ns; event_ns = next_event_ns()) {
    now_ns_ = std::max(now_ns_, event_ns);
    happen();
  }
  now_ns_ = std::max(now_ns_, now_ns);
}

bool BarometerModel::acknowledges(std::int64_t byte_count) {
  ++transactions;
  run_until(now_ns_ + (byte_count + 3) * byte_time_ns);
  if (unplugged || !answers()) return false;
  return nak_share == 0.0 || std::uniform_real_distribution<double>()(random_) >= nak_share;
}

int BarometerModel::read(std::uint8_t first, std::span<std::uint8_t> bytes) {
  if (!acknowledges(0)) return EREMOTEIO;
  begin_read(first);
  for (std::uint8_t& byte : bytes) {
    run_until(now_ns_ + byte_time_ns);
    byte = next_byte();
  }
  return 0;
}

int BarometerModel::write(std::uint8_t address, std::uint8_t value) {
  if (!acknowledges(1)) return EREMOTEIO;
  if (++writes != lost_write) take(address, value);
  return 0;
}

int BarometerModel::command(std::uint8_t code) {
  if (!acknowledges(0)) return EREMOTEIO;
  ++writes;
  obey(code);
  return 0;
}

int BarometerBus::read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept {
  if (has_bursts) return chip_->read(first, bytes);
  for (std::uint8_t& byte : bytes) {
    if (const int error = chip_->read(first++, {&byte, 1}); error != 0) return error;
  }
  return 0;
}

}  // namespace isobar::test
