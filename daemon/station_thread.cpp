// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/station_thread.hpp"

#include <cmath>

#include "daemon/message_loop.hpp"

namespace isobar {
namespace {

/// Memory of the noise, in samples: some seconds of a 32 Hz barometer.
constexpr double kNoiseMemorySamples = 200.0;
/// The estimate is told once it rests on so many samples: by then its own error is below a third.
constexpr std::uint64_t kSamplesToKnow = 50;

}  // namespace

StationThread::StationThread(const AltimeterConfig& config, const CompensationConfig& compensation,
                             ThreadSettings settings)
    : settings_(std::move(settings)),
      compensation_(compensation),
      noise_({config.initial_noise_pa, config.noise_floor_pa, config.noise_ceiling_pa, kNoiseMemorySamples}),
      barometer_(ipc::topics::kBarometer),
      publisher_(ipc::topics::kBaseBarometer),
      waiter_({&barometer_.raw()}) {}

StationThread::~StationThread() { stop(); }

void StationThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void StationThread::stop() noexcept {
  waiter_.stop();
  if (thread_.joinable()) thread_.join();
}

void StationThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  drain_until_stopped(waiter_, heartbeat_, [this] { drain(); });
}

void StationThread::drain() noexcept {
  while (const auto sample = barometer_.take()) take(*sample);
  own_.dropped_samples = barometer_.dropped();
  status_.put(own_);
}

void StationThread::take(const PressureSample& raw) noexcept {
  PressureSample measured = raw;
  const SensorCompensation::Result result = compensation_.apply(measured);
  own_.outside_calibration += result == SensorCompensation::Result::kOutside ? 1U : 0U;
  own_.without_temperature += result == SensorCompensation::Result::kNoTemperature ? 1U : 0U;
  // A sensor that is polled faster than it converts repeats its value, which is no measurement of noise.
  const bool changed = own_.samples == 0 || measured.pressure_pa != own_.newest.pressure_pa;
  if (own_.cadence.silent(measured.stamp_ns)) noise_.restart();
  if (changed) {
    noise_.add(measured.pressure_pa);
    ++measured_;
    own_.changed_ns = measured.stamp_ns;
  }
  ++own_.samples;
  own_.cadence.add(measured.stamp_ns);
  own_.newest = measured;
  if (std::isnan(measured.variance_pa2) && measured_ >= kSamplesToKnow) {
    own_.newest.variance_pa2 = noise_.variance();
  }
  if (!publisher_.send(own_.newest)) ++own_.samples_without_memory;
}

}  // namespace isobar
