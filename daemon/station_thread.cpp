// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/station_thread.hpp"

#include <cmath>

#include "daemon/message_loop.hpp"

namespace isobar {
namespace {

/// Memory of the noise estimate: 6 s of a 32 Hz barometer.
constexpr double kNoiseMemorySamples = 200.0;
/// The noise estimate is published from this many samples on: by then its own error is below a third.
constexpr std::uint64_t kMinNoiseSamples = 50;

}  // namespace

StationThread::StationThread(const AltimeterConfig& config, const CompensationConfig& compensation,
                             ThreadSettings settings)
    : compensation_(compensation),
      noise_({config.initial_noise_pa, config.noise_floor_pa, config.noise_ceiling_pa, kNoiseMemorySamples}),
      barometer_(ipc::topics::kBarometer),
      publisher_(ipc::topics::kBaseBarometer),
      waiter_({&barometer_.raw()}),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void StationThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
}

void StationThread::drain() noexcept {
  while (const auto sample = barometer_.take()) take(*sample);
  draft_status_.dropped_samples = barometer_.dropped();
  status_.put(draft_status_);
}

void StationThread::take(const PressureSample& raw) noexcept {
  PressureSample measured = raw;
  const SensorCompensation::Result result = compensation_.apply(measured);
  draft_status_.outside_calibration += result == SensorCompensation::Result::kOutside ? 1U : 0U;
  draft_status_.without_temperature += result == SensorCompensation::Result::kNoTemperature ? 1U : 0U;
  // A sensor polled faster than it converts repeats its value; repeats are no measurement of noise.
  const bool changed = draft_status_.samples == 0 || measured.pressure_pa != draft_status_.newest.pressure_pa;
  if (draft_status_.cadence.silent(measured.stamp_ns)) noise_.restart();
  if (changed) {
    noise_.add(measured.pressure_pa);
    ++noise_samples_;
    draft_status_.changed_ns = measured.stamp_ns;
  }
  ++draft_status_.samples;
  draft_status_.cadence.add(measured.stamp_ns);
  draft_status_.arrivals.add(measured.stamp_ns, measured.timing);
  draft_status_.newest = measured;
  if (std::isnan(measured.variance_pa2) && noise_samples_ >= kMinNoiseSamples) {
    draft_status_.newest.variance_pa2 = noise_.variance();
  }
  if (!publisher_.send(draft_status_.newest)) ++draft_status_.samples_without_memory;
}

}  // namespace isobar
