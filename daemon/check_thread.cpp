// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/check_thread.hpp"

#include <chrono>

#include "daemon/message_loop.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar {

namespace {

/// Polling of the sensors' queues: 256 samples last for a quarter of a second at 1 kHz, and 4 scans for 0.4 s at 10 Hz.
constexpr std::chrono::milliseconds kCheckPoll(50);
constexpr std::int64_t kJudgeNs = 500'000'000;
constexpr std::int64_t kJudgeClocksNs = 20'000'000'000;

void keep_new(const Findings& found, Findings& kept) {
  for (const Finding& finding : found.all()) {
    if (kept.find(finding.kind) == nullptr) kept.add(finding);
  }
}

}  // namespace

CheckThread::CheckThread(const InputCheckConfig& config, bool has_imu, ThreadSettings settings)
    : config_(config),
      has_imu_(has_imu),
      check_(std::make_unique<InputCheck>(config)),
      scans_(ipc::topics::kLidarScan),
      imu_(ipc::topics::kImu),
      barometer_(ipc::topics::kBarometer),
      base_barometer_(ipc::topics::kBaseBarometer),
      wheel_(ipc::topics::kWheel),
      waiter_({}),
      worker_(std::move(settings), waiter_, [this] { loop(); }) {}

void CheckThread::loop() noexcept {
  drain_until_stopped(
      waiter_, worker_.heartbeat(), [this] { drain(); }, [] { return std::chrono::nanoseconds(kCheckPoll); });
}

void CheckThread::drain() noexcept {
  const auto take_all = [this](auto& subscriber, const auto& add) {
    while (const auto message = subscriber.take()) {
      if (check_) add(*message);
    }
  };
  take_all(imu_, [this](const ImuSample& sample) {
    if (has_imu_) check_->add_imu(sample);
  });
  take_all(wheel_, [this](const WheelSample& sample) { check_->add_wheel(sample); });
  take_all(barometer_, [this](const PressureSample& sample) { check_->add_pressure(sample); });
  take_all(base_barometer_, [this](const PressureSample& sample) { check_->add_base_pressure(sample); });
  take_all(scans_, [this](const Scan& scan) { check_->add_scan(scan); });
  judge(RobotClock::now_ns());
}

void CheckThread::judge(std::int64_t now_ns) noexcept {
  if (!check_ || now_ns - judged_ns_ < kJudgeNs) return;
  judged_ns_ = now_ns;
  Findings found = check_->find();
  if (now_ns - clocks_judged_ns_ >= kJudgeClocksNs) {
    clocks_judged_ns_ = now_ns;
    check_->add_clocks(found);
  }
  keep_new(found, kept_);
  status_.put(kept_);
  if (check_->full()) renew();
}

// A robot that has not turned yet may still have a gyro in deg/s.
void CheckThread::renew() noexcept {
  const bool is_done = check_->turns_known();
  check_.reset();
  if (!is_done) check_ = std::make_unique<InputCheck>(config_);
}

}  // namespace isobar
