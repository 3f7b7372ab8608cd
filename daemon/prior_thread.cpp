// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/prior_thread.hpp"

#include <chrono>

#include "daemon/message_loop.hpp"
#include "drivers/datagram/udp.hpp"

namespace isobar {
namespace {

/// An IMU sample wakes this thread, the slow sensors do not, as only an IMU sample makes a prior. While it is
/// silent they are looked at so often: their queues hold 256 samples, and the health report wants to know
/// that they come.
constexpr std::chrono::milliseconds kWithoutImu(100);

}  // namespace

PriorThread::PriorThread(const PriorConfig& config, ThreadSettings settings)
    : settings_(std::move(settings)),
      estimator_(config),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel),
      publisher_(ipc::topics::kPrior),
      waiter_({&imu_.raw()}),
      deadline_(settings_.deadline_ms) {}

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
  drain_until_stopped(
      waiter_, heartbeat_, [this] { drain(); }, kWithoutImu);
}

// Seen here, behind all the ways in which a sample comes: by UDP or over DDS.
template <class Sample>
ipc::Received<Sample> PriorThread::take(ipc::Subscriber<Sample>& from, datagram::Kind kind) noexcept {
  ipc::Received<Sample> sample = from.take();
  if (sample) {
    ++own_.samples[static_cast<std::size_t>(kind)];
    own_.last_sample_ns[static_cast<std::size_t>(kind)] = sample->stamp_ns;
  }
  return sample;
}

// The slow sensors first: what they measured before an IMU sample belongs into its prior.
void PriorThread::drain() noexcept {
  using datagram::Kind;
  while (const auto sample = take(base_barometer_, Kind::kBasePressure)) {
    if (sample->station < own_.base_stations.size())
      own_.base_stations[sample->station].add(sample->stamp_ns);
    estimator_.add_base_pressure(*sample);
  }
  while (const auto sample = take(barometer_, Kind::kPressure)) estimator_.add_pressure(*sample);
  while (const auto sample = take(wheel_, Kind::kWheel)) estimator_.add_wheel(*sample);
  Prior prior;
  while (const auto sample = take(imu_, Kind::kImu)) {
    if (!estimator_.add_imu(*sample, prior)) continue;
    publisher_.send(prior);
    deadline_.note(prior.stamp_ns, RobotClock::now_ns());
    describe(prior);
  }
  own_.counters = estimator_.counters();
  own_.punctuality = deadline_.status();
  own_.barometers = estimator_.barometers();
  own_.dropped_samples = imu_.dropped() + barometer_.dropped() + base_barometer_.dropped() + wheel_.dropped();
  status_.put(own_);
}

void PriorThread::describe(const Prior& prior) noexcept {
  own_.stamp_ns = prior.stamp_ns;
  own_.height_m = prior.height_m;
  own_.height_variance_m2 = prior.height_variance_m2;
  own_.height_source = prior.height_source;
  own_.attitude_valid = prior.attitude_valid;
}

}  // namespace isobar
