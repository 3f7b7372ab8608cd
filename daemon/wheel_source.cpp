// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/wheel_source.hpp"

#include "drivers/encoder/gpio_lines.hpp"
#include "drivers/encoder/sensor.hpp"

namespace isobar {

std::unique_ptr<WheelThread> make_wheel_thread(const WheelSettings& wheel, const ThreadSettings& scheduling) {
  if (wheel.source != WheelSource::kEncoder) return nullptr;
  auto encoders =
      std::make_unique<encoder::Sensor>(wheel.encoder, std::make_unique<encoder::GpioLines>(wheel.encoder));
  return std::make_unique<WheelThread>(std::move(encoders), scheduling);
}

std::int64_t wheel_period_ns(const WheelSettings& wheel) { return 1'000'000'000 / wheel.encoder.rate_hz; }

}  // namespace isobar
