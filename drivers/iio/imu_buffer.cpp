// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/imu_buffer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace isobar::iio {

namespace {

/// Shortest time without a scan that is silence [ns]: with the 0.1 s of isobard's supervision said within 0.2 s.
constexpr std::int64_t kSilenceNs = 80'000'000;
/// Limit of the back-off [ns]: a device that returns must measure within 2 s.
constexpr std::int64_t kLongestWaitNs = 500'000'000;
/// Time after which the accelerometer is read again while a rate waits for it [ns].
constexpr std::int64_t kPairNs = 1'000'000;

std::unique_ptr<BufferDevice> accel_of(const ImuBufferSettings& s) {
  if (s.accel_folder.empty()) return nullptr;
  return std::make_unique<BufferDevice>(s.accel_folder, s.accel_device, s.trigger, s.rate_hz,
                                        Sensors::kAccel);
}

std::string place_of(const ImuBufferSettings& s) {
  return "IMU " + s.folder + (s.accel_folder.empty() ? "" : " and " + s.accel_folder);
}

}  // namespace

ImuBuffer::ImuBuffer(const ImuBufferSettings& settings)
    : place_(place_of(settings)),
      main_(settings.folder, settings.device, settings.trigger, settings.rate_hz,
            settings.accel_folder.empty() ? Sensors::kBoth : Sensors::kGyro),
      accel_(accel_of(settings)),
      faults_(std::max(kSilenceNs, 4'000'000'000 / settings.rate_hz), kLongestWaitNs) {}

Device<InertialReading>::Step ImuBuffer::step(std::int64_t now_ns) noexcept {
  Step step;
  if (main_.is_open()) {
    measure(now_ns, step);
  } else {
    step.next_ns = open(now_ns);
  }
  return step;
}

std::int64_t ImuBuffer::open(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  int error = 0;
  const char* fault = nullptr;
  // The gyro last: its rates would wait for the accelerations.
  if (accel_) fault = accel_->open(error);
  if (fault != nullptr) {
    ++faults_.counters().io_errors;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "accelerometer: %.75s", fault);
    return fail(error == 0 ? DeviceState::kWrongDevice : DeviceState::kNoAnswer, text.data(), now_ns, error);
  }
  fault = main_.open(error);
  if (fault != nullptr) {
    ++faults_.counters().io_errors;
    return fail(error == 0 ? DeviceState::kWrongDevice : DeviceState::kNoAnswer, fault, now_ns, error);
  }
  if (accel_ && (!accel_->has_time() || !main_.has_time())) {
    return fail(DeviceState::kWrongDevice, "two devices cannot be paired without time stamps", now_ns, 0);
  }
  pairs_.clear();
  anchor_ = ClockAnchor();
  faults_.note(main_.has_time() ? nullptr : "the buffer has no time stamps: receive times");
  faults_.expects_results(now_ns);
  return now_ns;
}

void ImuBuffer::close() noexcept {
  main_.close();
  if (accel_) accel_->close();
}

int ImuBuffer::receive() noexcept {
  int error = main_.receive();
  if (!accel_ || error != 0) return error;
  error = accel_->receive();
  InertialScan scan;
  while (accel_->next(scan)) pairs_.add_accel(scan);
  while (main_.next(scan)) pairs_.add_gyro(scan);
  return error;
}

bool ImuBuffer::next(InertialScan& scan) noexcept { return accel_ ? pairs_.next(scan) : main_.next(scan); }

void ImuBuffer::measure(std::int64_t now_ns, Step& step) noexcept {
  if (const int error = receive(); error != 0) {
    ++faults_.counters().io_errors;
    step.next_ns = fail(DeviceState::kNoAnswer, "unplugged", now_ns, error);
    return;
  }
  InertialScan scan;
  while (next(scan)) {
    if (take(scan, now_ns, step)) return;
  }
  step.next_ns = now_ns + (pairs_.gyro_waits() ? kPairNs : kSilenceNs + 1'000'000);
  if (pairs_.clocks_differ()) {
    faults_.problem(DeviceState::kSilent, "the time stamps of its two devices are a second apart and more");
  }
  if (!faults_.overdue(now_ns)) return;
  close();
  step.next_ns = faults_.give_up(now_ns);
}

/// True when the step is done: it has a sample, or the device failed.
bool ImuBuffer::take(const InertialScan& scan, std::int64_t now_ns, Step& step) noexcept {
  ImuSample imu;
  imu.gyro_rad_s = scan.gyro_rad_s;
  imu.accel_m_s2 = scan.accel_m_s2;
  imu.stamp_ns = now_ns;
  imu.timing.received_ns = now_ns;
  if (main_.has_time()) {
    (void)anchor_.add(scan.time_ns, now_ns);
    imu.stamp_ns = anchor_.to_host_ns(anchor_.device_unwrapped_ns());
    imu.timing.clock_ahead_ns = anchor_.device_ahead_ns();
  }
  const InertialWatch::Verdict verdict = watch_.judge(imu, now_ns, faults_);
  if (verdict == InertialWatch::Verdict::kRefused) return false;
  if (verdict == InertialWatch::Verdict::kStuck) {
    step.next_ns = fail(DeviceState::kStuck, "the values no longer change", now_ns, 0);
    return true;
  }
  step.has_sample = true;
  step.sample.has_imu = true;
  step.sample.imu = imu;
  step.next_ns = now_ns;  // more may be waiting
  return true;
}

std::int64_t ImuBuffer::fail(DeviceState state, const char* what, std::int64_t now_ns, int error) noexcept {
  close();
  return faults_.fail(state, what, now_ns, error);
}

}  // namespace isobar::iio
