// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/barometer_source.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include "drivers/bmp390/sensor.hpp"
#include "drivers/bmp581/sensor.hpp"
#include "drivers/bus/choice.hpp"
#include "drivers/dps310/sensor.hpp"
#include "drivers/gpio/edge_line.hpp"
#include "drivers/icp20100/sensor.hpp"
#include "drivers/iio/barometer.hpp"
#include "drivers/ms5611/sensor.hpp"

namespace isobar {
namespace {

using PressureDevice = std::unique_ptr<Device<PressureSample>>;

/// Driver of a sensor of this machine.
struct Driver {
  BarometerSource source;
  PressureDevice (*make)(const BarometerSettings& settings, std::int64_t stuck_time_ns);
};

template <class Sensor, class Settings>
PressureDevice on_bus(const Settings& settings, const SpiFormat& format, std::int64_t stuck_time_ns) {
  return std::make_unique<Sensor>(settings, make_register_bus(settings.bus, settings.address, format),
                                  stuck_time_ns);
}

constexpr std::array kDrivers{
    Driver{BarometerSource::kDps310,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) -> PressureDevice {
             std::unique_ptr<EdgeLine> line;
             if (s.dps310.ready_line >= 0) {
               line = std::make_unique<GpioLine>(
                   s.dps310.ready_chip, static_cast<unsigned>(s.dps310.ready_line), GpioLine::Edges::kRising);
             }
             return std::make_unique<dps310::Sensor>(
                 s.dps310, make_register_bus(s.dps310.bus, s.dps310.address, dps310::kSpiFormat),
                 stuck_time_ns, std::move(line));
           }},
    Driver{BarometerSource::kBmp581,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) {
             return on_bus<bmp581::Sensor>(s.bmp581, bmp581::kSpiFormat, stuck_time_ns);
           }},
    Driver{BarometerSource::kBmp390,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) {
             return on_bus<bmp390::Sensor>(s.bmp390, bmp390::kSpiFormat, stuck_time_ns);
           }},
    Driver{BarometerSource::kIcp20100,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) {
             return on_bus<icp20100::Sensor>(s.icp20100, icp20100::kSpiFormat, stuck_time_ns);
           }},
    Driver{BarometerSource::kMs5611,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) {
             return on_bus<ms5611::Sensor>(s.ms5611, ms5611::kSpiFormat, stuck_time_ns);
           }},
    Driver{BarometerSource::kSetra278,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) -> PressureDevice {
             return std::make_unique<iio::Barometer>(s.setra278, stuck_time_ns);
           }},
    Driver{BarometerSource::kIio,
           [](const BarometerSettings& s, std::int64_t stuck_time_ns) -> PressureDevice {
             return std::make_unique<iio::Barometer>(s.iio, stuck_time_ns);
           }},
};

/// Null for a source that is no sensor of this machine.
PressureDevice make_device(const BarometerSettings& settings) {
  const auto* const driver = std::find_if(kDrivers.begin(), kDrivers.end(),
                                          [&](const Driver& d) { return d.source == settings.source; });
  if (driver == kDrivers.end()) return nullptr;
  return driver->make(settings, static_cast<std::int64_t>(settings.stuck_time_s * 1e9));
}

}  // namespace

std::unique_ptr<BarometerThread> make_barometer_thread(const BarometerSettings& settings,
                                                       const ThreadSettings& scheduling) {
  std::unique_ptr<Device<PressureSample>> device = make_device(settings);
  return device ? std::make_unique<BarometerThread>(std::move(device), scheduling) : nullptr;
}

}  // namespace isobar
