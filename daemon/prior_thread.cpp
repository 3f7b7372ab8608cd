// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/prior_thread.hpp"

#include <chrono>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "daemon/message_loop.hpp"
#include "daemon/start_over.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {
namespace {

/// Polling interval of a silent IMU. Only IMU samples wake this thread, since
/// only they produce priors; the slow sensors are polled, so that their queues
/// (256 samples) do not overflow and the health report sees them.
constexpr std::chrono::milliseconds kPollOfSilentImu(100);

}  // namespace

PriorThread::PriorThread(const PriorConfig& config, ThreadSettings settings)
    : has_imu_(config.has_imu),
      estimator_(config),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel),
      publisher_(ipc::topics::kPrior),
      waiter_({&imu_.raw()}),
      deadline_(settings.deadline_ms),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void PriorThread::loop() noexcept {
  drain_until_stopped(
      waiter_, worker_.heartbeat(), [this] { drain(); }, [this] { return poll(); });
}

// Without an IMU this thread wakes itself.
std::chrono::nanoseconds PriorThread::poll() const noexcept {
  return has_imu_ ? std::chrono::nanoseconds(kPollOfSilentImu) : std::chrono::nanoseconds(PriorPace::kStepNs);
}

// Counted here, where samples from UDP and from DDS arrive on the same topics.
template <class Sample>
ipc::Received<Sample> PriorThread::take(ipc::Subscriber<Sample>& from, datagram::Kind kind) noexcept {
  ipc::Received<Sample> sample = from.take();
  if (sample) {
    ++draft_status_.samples[static_cast<std::size_t>(kind)];
    draft_status_.last_sample_ns[static_cast<std::size_t>(kind)] = sample->stamp_ns;
  }
  return sample;
}

// Of the sender that is used: two would look like one with twice the rate.
template <class Sample>
void PriorThread::note_arrival(const Sample& sample, datagram::Kind kind) noexcept {
  draft_status_.arrivals[static_cast<std::size_t>(kind)].add(sample.stamp_ns, sample.timing);
}

void PriorThread::leave_out(const PriorConfig& config, const UsableSensors& usable, double deadline_ms) {
  auto estimator = std::make_unique<PriorEstimator>(config);
  estimator->resume(status().datum);
  changes_.offer(std::make_unique<Change>(Change{config, deadline_ms, std::move(estimator), usable}));
}

// Swaps, so that the main thread frees the estimate that was in use.
void PriorThread::obey(Change& change) noexcept {
  deadline_.set_limit(change.deadline_ms);
  if (change.estimator == nullptr) {
    estimator_.configure(change.config);
    return;
  }
  std::swap(estimator_, *change.estimator);
  has_imu_ = change.config.has_imu;
  usable_ = change.usable;
}

// Slow sensors first: a measurement older than an IMU sample contributes to that sample's prior.
void PriorThread::drain() noexcept {
  changes_.take([this](Change& change) { obey(change); });
  using datagram::Kind;
  while (const auto sample = take(base_barometer_, Kind::kBasePressure)) {
    const std::size_t station = sample->station;
    if (station >= base_paths_.size()) continue;  // of another build
    const bool is_used = base_paths_[station].check(*sample);
    draft_status_.base_paths[station] = base_paths_[station].status();
    if (is_used && station == 0) note_arrival(*sample, Kind::kBasePressure);
    if (!is_used || !usable_.barometers) continue;
    draft_status_.base_stations[station].add(sample->stamp_ns);
    estimator_.add_base_pressure(*sample);
  }
  while (const auto sample = take(barometer_, Kind::kPressure)) {
    note_arrival(*sample, Kind::kPressure);
    if (usable_.barometers) estimator_.add_pressure(*sample);
  }
  while (const auto sample = take(wheel_, Kind::kWheel)) {
    if (!wheel_path_.check(*sample)) continue;
    note_arrival(*sample, Kind::kWheel);
    if (usable_.wheels) estimator_.add_wheel(*sample);
  }
  drain_imu();
  if (!has_imu_) advance(RobotClock::now_ns());
  draft_status_.imu_path = imu_path_.status();
  draft_status_.wheel_path = wheel_path_.status();
  draft_status_.counters = estimator_.counters();
  draft_status_.punctuality = deadline_.status();
  draft_status_.datum = estimator_.height_datum();
  draft_status_.barometers = estimator_.barometers();
  // In the order of Kind.
  draft_status_.dropped = {imu_.dropped(), barometer_.dropped(), base_barometer_.dropped(), wheel_.dropped()};
  draft_status_.dropped_samples =
      std::accumulate(draft_status_.dropped.begin(), draft_status_.dropped.end(), std::uint64_t{0});
  status_.put(draft_status_);
}

void PriorThread::drain_imu() noexcept {
  Prior prior;
  constexpr auto kImuIndex = static_cast<std::size_t>(datagram::Kind::kImu);
  std::int64_t before_ns = draft_status_.last_sample_ns[kImuIndex];
  while (const auto sample = take(imu_, datagram::Kind::kImu)) {
    if (!imu_path_.check(*sample)) continue;
    note_arrival(*sample, datagram::Kind::kImu);
    if (before_ns != 0 && std::abs(sample->stamp_ns - before_ns) > StartOver::kSilenceNs) {
      draft_status_.imu_resumed_ns = sample->stamp_ns;
    }
    before_ns = sample->stamp_ns;
    if (has_imu_ && estimator_.add_imu(*sample, prior)) publish(prior);
  }
}

void PriorThread::advance(std::int64_t now_ns) noexcept {
  Prior prior;
  for (std::int64_t stamp_ns = 0; pace_.next(now_ns, stamp_ns);) {
    if (estimator_.advance(stamp_ns, prior)) publish(prior);
  }
}

void PriorThread::publish(const Prior& prior) noexcept {
  publisher_.send(prior);
  deadline_.note(prior.stamp_ns, RobotClock::now_ns());
  describe(prior);
}

void PriorThread::describe(const Prior& prior) noexcept {
  draft_status_.stamp_ns = prior.stamp_ns;
  draft_status_.height_m = prior.height_m;
  draft_status_.height_variance_m2 = prior.height_variance_m2;
  draft_status_.height_source = prior.height_source;
  draft_status_.attitude_valid = prior.attitude_valid;
}

}  // namespace isobar
