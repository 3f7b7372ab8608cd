// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/imu_buffer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "drivers/iio/attribute.hpp"

namespace isobar::iio {

namespace {

/// Shortest time without a scan that is silence [ns]: with the 0.1 s of isobard's supervision said within 0.2 s.
constexpr std::int64_t kSilenceNs = 80'000'000;
/// Limit of the back-off [ns]: a device that returns must measure within 2 s.
constexpr std::int64_t kLongestWaitNs = 500'000'000;
/// Largest deviation of the rate that the device holds from the one asked for: rounded in its text.
constexpr double kRateTolerance = 0.02;
/// Scans that the kernel keeps: 0.3 s at 400 Hz.
constexpr const char* kBufferScans = "128";

std::string device_of(const ImuBufferSettings& settings) {
  return settings.device.empty() ? "/dev" + settings.folder.substr(settings.folder.find_last_of('/'))
                                 : settings.device;
}

/// For for_each_file(): switches every channel on or off.
struct ChannelChoice {
  const std::string* folder;
  int error = 0;
  static void visit(void* context, std::string_view name) noexcept {
    constexpr std::string_view kEnable = "_en";
    auto& choice = *static_cast<ChannelChoice*>(context);
    if (!name.ends_with(kEnable)) return;
    const std::string_view channel = name.substr(0, name.size() - kEnable.size());
    const bool wanted = std::find(kImuChannels.begin(), kImuChannels.end(), channel) != kImuChannels.end();
    const int error = write_attribute(*choice.folder, name, wanted ? "1" : "0");
    if (error != 0 && choice.error == 0) choice.error = error;
  }
};

}  // namespace

ImuBuffer::ImuBuffer(const ImuBufferSettings& settings)
    : settings_(settings),
      place_("IMU " + settings.folder),
      scan_folder_(settings.folder + "/scan_elements"),
      faults_(std::max(kSilenceNs, 4'000'000'000 / settings.rate_hz), kLongestWaitNs) {
  settings_.device = device_of(settings);
}

Device<InertialReading>::Step ImuBuffer::step(std::int64_t now_ns) noexcept {
  Step step;
  if (file_ >= 0) {
    measure(now_ns, step);
  } else {
    step.next_ns = open(now_ns);
  }
  return step;
}

std::int64_t ImuBuffer::open(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  int error = 0;
  if (const char* fault = set_up(error); fault != nullptr) {
    ++faults_.counters().io_errors;
    return fail(error == 0 ? DeviceState::kWrongDevice : DeviceState::kNoAnswer, fault, now_ns, error);
  }
  file_ = ::open(settings_.device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) return fail(DeviceState::kNoAnswer, "the buffer cannot be opened", now_ns, errno);
  // Last: the kernel begins to fill the buffer.
  if (error = write_attribute(settings_.folder, "buffer/enable", "1"); error != 0) {
    return fail(DeviceState::kNoAnswer, "the buffer cannot be switched on: a trigger?", now_ns, error);
  }
  window_.clear();
  anchor_ = ClockAnchor();
  faults_.note(layout_.has(kTimestampChannel) ? nullptr : "the buffer has no time stamps: receive times");
  faults_.expects_results(now_ns);
  return now_ns;
}

const char* ImuBuffer::set_up(int& error) noexcept {
  error = write_attribute(settings_.folder, "buffer/enable", "0");
  if (error != 0) return error == ENOENT ? "no such device, or it has no buffer" : "no right to its files?";
  if (const char* fault = set_rate(error); fault != nullptr) return fault;
  if (!settings_.trigger.empty()) {
    error = write_attribute(settings_.folder, "trigger/current_trigger", settings_.trigger);
    if (error != 0) return "the device takes no such trigger";
  }
  if (const char* fault = choose_channels(error); fault != nullptr) return fault;
  if (const char* fault = read_scales(error); fault != nullptr) return fault;
  // Optional attributes. A clock that may be set would step the stamps.
  (void)write_attribute(settings_.folder, "current_timestamp_clock", "monotonic");
  (void)write_attribute(settings_.folder, "buffer/length", kBufferScans);
  (void)write_attribute(settings_.folder, "buffer/watermark", "1");
  return nullptr;
}

const char* ImuBuffer::set_rate(int& error) noexcept {
  std::array<char, 16> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), settings_.rate_hz);
  const std::string_view wanted(text.data(), static_cast<std::size_t>(end - text.data()));
  for (const char* name :
       {"sampling_frequency", "in_anglvel_sampling_frequency", "in_accel_sampling_frequency"}) {
    error = write_attribute(settings_.folder, name, wanted);
    if (error == ENOENT) continue;  // has another one, or the trigger's rate
    double held_hz = 0.0;
    if (error == 0) error = read_number(settings_.folder, name, held_hz);
    const bool as_wanted = std::abs(held_hz - settings_.rate_hz) <= kRateTolerance * settings_.rate_hz;
    if (error != 0 || !as_wanted) return "the device has no such rate: see sampling_frequency_available";
  }
  error = 0;
  return nullptr;
}

const char* ImuBuffer::choose_channels(int& error) noexcept {
  ChannelChoice choice{&scan_folder_};
  error = for_each_file(scan_folder_, &ChannelChoice::visit, &choice);
  if (error == 0) error = choice.error;
  if (error != 0) return "the channels cannot be chosen";
  layout_ = ScanLayout();
  for (std::size_t channel = 0; channel < kImuChannels.size(); ++channel) {
    if (const char* fault = read_channel(channel, error); fault != nullptr) return fault;
  }
  return layout_.finish() ? nullptr : "two channels have one index";
}

const char* ImuBuffer::read_channel(std::size_t channel, int& error) noexcept {
  std::array<char, 48> name{};
  const auto attribute = [&](const char* suffix) {
    std::snprintf(name.data(), name.size(), "%s%s", kImuChannels[channel].data(), suffix);
    return name.data();
  };
  const Attribute type_text = read_attribute(scan_folder_, attribute("_type"));
  if (type_text.error == ENOENT) {
    return channel == kTimestampChannel ? nullptr : "it has no accelerometer and gyro in one device";
  }
  double index = 0.0;
  error = type_text.error != 0 ? type_text.error : read_number(scan_folder_, attribute("_index"), index);
  if (error != 0) return "a channel's attributes cannot be read";
  const std::optional<ElementType> type = parse_element_type(type_text.view());
  if (!type) return "a channel of an unknown type";
  layout_.add(channel, static_cast<int>(std::clamp(index, 0.0, 1e6)), *type);
  return nullptr;
}

const char* ImuBuffer::read_scales(int& error) noexcept {
  constexpr std::array<const char*, 2> kKinds{"in_anglvel", "in_accel"};
  constexpr std::string_view kAxes = "xyz";
  for (std::size_t channel = 0; channel < kTimestampChannel; ++channel) {
    const auto row = static_cast<Eigen::Index>(channel);
    scale_[row] = 1.0;
    offset_[row] = 0.0;
    const char* kind = kKinds[channel / 3];
    const char axis = kAxes[channel % 3];
    error = read_constant(kind, axis, "_scale", scale_[row]);
    if (error != 0) return "it has no scale";  // raw numbers: no units are known
    error = read_constant(kind, axis, "_offset", offset_[row]);
    if (error != 0 && error != ENOENT) return "its offset cannot be read";
  }
  error = 0;
  return nullptr;
}

int ImuBuffer::read_constant(const char* kind, char axis, const char* suffix, double& value) const noexcept {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "%s_%c%s", kind, axis, suffix);
  const int error = read_number(settings_.folder, name.data(), value);
  if (error != ENOENT) return error;
  std::snprintf(name.data(), name.size(), "%s%s", kind, suffix);
  return read_number(settings_.folder, name.data(), value);
}

void ImuBuffer::close() noexcept {
  if (file_ < 0) return;
  ::close(file_);
  file_ = -1;
  (void)write_attribute(settings_.folder, "buffer/enable", "0");
}

int ImuBuffer::receive() noexcept {
  const std::span<std::uint8_t> room = window_.room();
  // A multiple of the scan, which the kernel's buffer requires of a reader.
  const std::size_t wanted = (room.size() / layout_.scan_bytes() - 1) * layout_.scan_bytes();
  const ssize_t count = ::read(file_, room.data(), wanted);
  if (count > 0) {
    window_.filled(static_cast<std::size_t>(count));
    return 0;
  }
  if (count == 0) return ENODEV;
  return errno == EAGAIN || errno == EINTR ? 0 : errno;
}

void ImuBuffer::measure(std::int64_t now_ns, Step& step) noexcept {
  if (window_.bytes().size() < layout_.scan_bytes()) {
    if (const int error = receive(); error != 0) {
      ++faults_.counters().io_errors;
      step.next_ns = fail(DeviceState::kNoAnswer, "unplugged", now_ns, error);
      return;
    }
  }
  while (window_.bytes().size() >= layout_.scan_bytes()) {
    if (take_scan(now_ns, step)) return;
  }
  step.next_ns = now_ns + kSilenceNs + 1'000'000;
  if (!faults_.overdue(now_ns)) return;
  close();
  step.next_ns = faults_.give_up(now_ns);
}

/// True when the step is done: it has a sample, or the device failed.
bool ImuBuffer::take_scan(std::int64_t now_ns, Step& step) noexcept {
  const std::span<const std::uint8_t> scan = window_.bytes().first(layout_.scan_bytes());
  ImuSample imu;
  const auto value = [&](std::size_t channel) {
    const auto row = static_cast<Eigen::Index>(channel);
    return (static_cast<double>(layout_.value(scan, channel)) + offset_[row]) * scale_[row];
  };
  imu.gyro_rad_s = {value(0), value(1), value(2)};
  imu.accel_m_s2 = {value(3), value(4), value(5)};
  imu.stamp_ns = now_ns;
  imu.timing.received_ns = now_ns;
  if (layout_.has(kTimestampChannel)) {
    (void)anchor_.add(layout_.value(scan, kTimestampChannel), now_ns);
    imu.stamp_ns = anchor_.to_host_ns(anchor_.device_unwrapped_ns());
    imu.timing.clock_ahead_ns = anchor_.device_ahead_ns();
  }
  window_.drop(layout_.scan_bytes());
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
