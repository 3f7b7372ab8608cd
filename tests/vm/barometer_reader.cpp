// SPDX-License-Identifier: BSD-3-Clause
// The DPS310 driver alone on a kernel bus; prints its samples.
// Usage: dps310_reader BUS SECONDS
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/sensor.hpp"

int main(int count, char** arguments) {
  using namespace isobar;
  if (count != 3) {
    std::fprintf(stderr, "usage: dps310_reader BUS SECONDS\n");
    return 64;
  }
  dps310::Settings settings;
  settings.bus = arguments[1];
  dps310::Sensor sensor(settings, std::make_unique<SmbusDevice>(settings.bus, 0x77), 0);
  const auto now_ns = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
  const std::int64_t end_ns = now_ns() + std::atoi(arguments[2]) * 1'000'000'000LL;
  double pressure_sum = 0.0;
  double temperature_sum = 0.0;
  int samples = 0;
  while (now_ns() < end_ns) {
    const Device<PressureSample>::Step step = sensor.step(now_ns());
    if (step.has_sample) {
      pressure_sum += step.sample.pressure_pa;
      temperature_sum += step.sample.temperature_c;
      ++samples;
    }
    std::this_thread::sleep_for(std::chrono::nanoseconds(step.next_ns - now_ns()));
  }
  std::printf("%s: %d samples, mean %.2f Pa, %.3f degC %s\n", sensor.place().c_str(), samples,
              pressure_sum / samples, temperature_sum / samples, sensor.status().fault.data());
  return samples > 0 ? 0 : 1;
}
