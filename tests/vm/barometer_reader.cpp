// SPDX-License-Identifier: BSD-3-Clause
// The driver of a barometer alone on a kernel bus; prints its samples.
// Usage: barometer_reader BUS {dps310|bmp581|bmp390|icp20100|ms5611} SECONDS
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "drivers/bmp390/sensor.hpp"
#include "drivers/bmp581/sensor.hpp"
#include "drivers/bus/choice.hpp"
#include "drivers/dps310/sensor.hpp"
#include "drivers/icp20100/sensor.hpp"
#include "drivers/ms5611/sensor.hpp"

namespace {

using namespace isobar;

template <class Sensor, class Settings>
std::unique_ptr<Device<PressureSample>> on(const char* bus, Settings settings, const SpiFormat& format) {
  settings.bus = bus;
  return std::make_unique<Sensor>(settings, make_register_bus(settings.bus, settings.address, format), 0);
}

std::unique_ptr<Device<PressureSample>> make_sensor(const std::string& name, const char* bus) {
  if (name == "dps310") return on<dps310::Sensor>(bus, dps310::Settings{}, dps310::kSpiFormat);
  if (name == "bmp581") return on<bmp581::Sensor>(bus, bmp581::Settings{}, bmp581::kSpiFormat);
  if (name == "bmp390") return on<bmp390::Sensor>(bus, bmp390::Settings{}, bmp390::kSpiFormat);
  if (name == "icp20100") return on<icp20100::Sensor>(bus, icp20100::Settings{}, icp20100::kSpiFormat);
  if (name == "ms5611") return on<ms5611::Sensor>(bus, ms5611::Settings{}, ms5611::kSpiFormat);
  return nullptr;
}

}  // namespace

int main(int count, char** arguments) {
  const auto sensor = count == 4 ? make_sensor(arguments[2], arguments[1]) : nullptr;
  if (sensor == nullptr) {
    std::fprintf(stderr, "usage: barometer_reader BUS {dps310|bmp581|bmp390|icp20100|ms5611} SECONDS\n");
    return 64;
  }
  const auto now_ns = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
  const std::int64_t end_ns = now_ns() + std::atoi(arguments[3]) * 1'000'000'000LL;
  double pressure_sum = 0.0;
  double temperature_sum = 0.0;
  int samples = 0;
  while (now_ns() < end_ns) {
    const Device<PressureSample>::Step step = sensor->step(now_ns());
    if (step.has_sample) {
      pressure_sum += step.sample.pressure_pa;
      temperature_sum += step.sample.temperature_c;
      ++samples;
    }
    std::this_thread::sleep_for(std::chrono::nanoseconds(step.next_ns - now_ns()));
  }
  std::printf("%s: %d samples, mean %.2f Pa, %.3f degC %s\n", sensor->place().c_str(), samples,
              pressure_sum / samples, temperature_sum / samples, sensor->status().fault.data());
  return samples > 0 ? 0 : 1;
}
