// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/prior_thread.hpp"

namespace isobar {

PriorThread::PriorThread(const PriorConfig& config, ThreadSettings settings)
    : settings_(std::move(settings)),
      estimator_(config),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel),
      publisher_(ipc::topics::kPrior),
      waiter_({&imu_.raw(), &barometer_.raw(), &base_barometer_.raw(), &wheel_.raw()}) {}

PriorThread::~PriorThread() { stop(); }

void PriorThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void PriorThread::stop() noexcept {
  waiter_.stop();
  if (thread_.joinable()) thread_.join();
}

void PriorThread::loop() noexcept {
  (void)apply_to_this_thread(settings_);
  while (waiter_.wait() != ipc::Waiter::Event::kStopped) drain();
}

// The slow sensors first: what they measured before an IMU sample belongs into its prior.
void PriorThread::drain() noexcept {
  while (const auto sample = base_barometer_.take()) estimator_.add_base_pressure(*sample);
  while (const auto sample = barometer_.take()) estimator_.add_pressure(*sample);
  while (const auto sample = wheel_.take()) estimator_.add_wheel(*sample);
  Prior prior;
  while (const auto sample = imu_.take()) {
    if (!estimator_.add_imu(*sample, prior)) continue;
    publisher_.send(prior);
    report(prior);
  }
}

void PriorThread::report(const Prior& prior) noexcept {
  PriorStatus status;
  status.counters = estimator_.counters();
  status.dropped_samples =
      imu_.dropped() + barometer_.dropped() + base_barometer_.dropped() + wheel_.dropped();
  status.stamp_ns = prior.stamp_ns;
  status.height_m = prior.height_m;
  status.height_variance_m2 = prior.height_variance_m2;
  status.height_source = prior.height_source;
  status.attitude_valid = prior.attitude_valid;
  status.velocity_valid = prior.velocity_valid;
  status_.put(status);
}

}  // namespace isobar
