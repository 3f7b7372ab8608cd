// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/barometer_source.hpp"

#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/sensor.hpp"
#include "drivers/iio/barometer.hpp"

namespace isobar {
namespace {

std::unique_ptr<Device<PressureSample>> make_device(const BarometerSettings& settings) {
  const auto stuck_time_ns = static_cast<std::int64_t>(settings.stuck_time_s * 1e9);
  switch (settings.source) {
    case BarometerSource::kDatagram:
    case BarometerSource::kNone:
      return nullptr;
    case BarometerSource::kDps310:
      return std::make_unique<dps310::Sensor>(
          settings.dps310,
          std::make_unique<SmbusDevice>(settings.dps310.bus, settings.dps310.address == "0x76" ? 0x76 : 0x77),
          stuck_time_ns);
    case BarometerSource::kSetra278:
      return std::make_unique<iio::Barometer>(settings.setra278, stuck_time_ns);
    case BarometerSource::kIio:
      return std::make_unique<iio::Barometer>(settings.iio, stuck_time_ns);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<BarometerThread> make_barometer_thread(const BarometerSettings& settings,
                                                       const ThreadSettings& scheduling) {
  std::unique_ptr<Device<PressureSample>> device = make_device(settings);
  return device ? std::make_unique<BarometerThread>(std::move(device), scheduling) : nullptr;
}

}  // namespace isobar
