// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/iio/buffer_device.hpp"

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

/// Largest deviation of the rate that the device holds from the one asked for: rounded in its text.
constexpr double kRateTolerance = 0.02;
/// Scans that the kernel keeps: 0.3 s at 400 Hz.
constexpr const char* kBufferScans = "128";

/// Whether a channel of kImuChannels belongs to these sensors; the time stamp does to all.
bool is_of(Sensors sensors, std::size_t channel) {
  constexpr std::size_t kFirstAccel = 3;
  if (channel == kTimestampChannel || sensors == Sensors::kBoth) return true;
  return (sensors == Sensors::kGyro) == (channel < kFirstAccel);
}

const char* missing_text(Sensors sensors) {
  if (sensors == Sensors::kGyro) return "it has no gyro";
  return sensors == Sensors::kAccel ? "it has no accelerometer"
                                    : "it has not both accelerometer and gyro: set imu.iio.accel_folder";
}

/// For for_each_file(): switches every channel on or off.
struct ChannelChoice {
  const std::string* folder;
  Sensors sensors;
  int error = 0;
  static void visit(void* context, std::string_view name) noexcept {
    constexpr std::string_view kEnable = "_en";
    auto& choice = *static_cast<ChannelChoice*>(context);
    if (!name.ends_with(kEnable)) return;
    const std::string_view channel = name.substr(0, name.size() - kEnable.size());
    const auto* const found = std::find(kImuChannels.begin(), kImuChannels.end(), channel);
    const bool wanted = found != kImuChannels.end() &&
                        is_of(choice.sensors, static_cast<std::size_t>(found - kImuChannels.begin()));
    const int error = write_attribute(*choice.folder, name, wanted ? "1" : "0");
    if (error != 0 && choice.error == 0) choice.error = error;
  }
};

}  // namespace

BufferDevice::BufferDevice(const std::string& folder, const std::string& device, const std::string& trigger,
                           int rate_hz, Sensors sensors)
    : folder_(folder),
      device_(device.empty() ? "/dev" + folder.substr(std::min(folder.find_last_of('/'), folder.size()))
                             : device),
      trigger_(trigger),
      rate_hz_(rate_hz),
      sensors_(sensors),
      scan_folder_(folder + "/scan_elements") {}

const char* BufferDevice::open(int& error) noexcept {
  if (const char* fault = set_up(error); fault != nullptr) return fault;
  file_ = ::open(device_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) {
    error = errno;
    return "the buffer cannot be opened";
  }
  // Last: the kernel begins to fill the buffer.
  if (error = write_attribute(folder_, "buffer/enable", "1"); error != 0) {
    return "the buffer cannot be switched on: a trigger?";
  }
  window_.clear();
  return nullptr;
}

const char* BufferDevice::set_up(int& error) noexcept {
  error = write_attribute(folder_, "buffer/enable", "0");
  if (error != 0) return error == ENOENT ? "no such device, or it has no buffer" : "no right to its files?";
  if (const char* fault = set_rate(error); fault != nullptr) return fault;
  if (!trigger_.empty()) {
    error = write_attribute(folder_, "trigger/current_trigger", trigger_);
    if (error != 0) return "the device takes no such trigger";
  }
  if (const char* fault = choose_channels(error); fault != nullptr) return fault;
  if (const char* fault = read_scales(error); fault != nullptr) return fault;
  // Optional attributes. A clock that may be set would step the stamps.
  (void)write_attribute(folder_, "current_timestamp_clock", "monotonic");
  (void)write_attribute(folder_, "buffer/length", kBufferScans);
  (void)write_attribute(folder_, "buffer/watermark", "1");
  return nullptr;
}

const char* BufferDevice::set_rate(int& error) noexcept {
  std::array<char, 16> text{};
  const auto [end, failure] = std::to_chars(text.data(), text.data() + text.size(), rate_hz_);
  const std::string_view wanted(text.data(), static_cast<std::size_t>(end - text.data()));
  for (const char* name :
       {"sampling_frequency", "in_anglvel_sampling_frequency", "in_accel_sampling_frequency"}) {
    error = write_attribute(folder_, name, wanted);
    if (error == ENOENT) continue;  // has another one, or the trigger's rate
    double held_hz = 0.0;
    if (error == 0) error = read_number(folder_, name, held_hz);
    const bool as_wanted = std::abs(held_hz - rate_hz_) <= kRateTolerance * rate_hz_;
    if (error != 0 || !as_wanted) return "the device has no such rate: see sampling_frequency_available";
  }
  error = 0;
  return nullptr;
}

const char* BufferDevice::choose_channels(int& error) noexcept {
  ChannelChoice choice{&scan_folder_, sensors_};
  error = for_each_file(scan_folder_, &ChannelChoice::visit, &choice);
  if (error == 0) error = choice.error;
  if (error != 0) return "the channels cannot be chosen";
  layout_ = ScanLayout();
  for (std::size_t channel = 0; channel < kImuChannels.size(); ++channel) {
    if (!is_of(sensors_, channel)) continue;
    if (const char* fault = read_channel(channel, error); fault != nullptr) return fault;
  }
  return layout_.finish() ? nullptr : "two channels have one index";
}

const char* BufferDevice::read_channel(std::size_t channel, int& error) noexcept {
  std::array<char, 48> name{};
  const auto attribute = [&](const char* suffix) {
    std::snprintf(name.data(), name.size(), "%s%s", kImuChannels[channel].data(), suffix);
    return name.data();
  };
  const Attribute type_text = read_attribute(scan_folder_, attribute("_type"));
  if (type_text.error == ENOENT) {
    return channel == kTimestampChannel ? nullptr : missing_text(sensors_);
  }
  double index = 0.0;
  error = type_text.error != 0 ? type_text.error : read_number(scan_folder_, attribute("_index"), index);
  if (error != 0) return "a channel's attributes cannot be read";
  const std::optional<ElementType> type = parse_element_type(type_text.view());
  if (!type) return "a channel of an unknown type";
  layout_.add(channel, static_cast<int>(std::clamp(index, 0.0, 1e6)), *type);
  return nullptr;
}

const char* BufferDevice::read_scales(int& error) noexcept {
  constexpr std::array<const char*, 2> kKinds{"in_anglvel", "in_accel"};
  constexpr std::string_view kAxes = "xyz";
  for (std::size_t channel = 0; channel < kTimestampChannel; ++channel) {
    const auto row = static_cast<Eigen::Index>(channel);
    scale_[row] = 1.0;
    offset_[row] = 0.0;
    if (!is_of(sensors_, channel)) continue;
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

int BufferDevice::read_constant(const char* kind, char axis, const char* suffix,
                                double& value) const noexcept {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "%s_%c%s", kind, axis, suffix);
  const int error = read_number(folder_, name.data(), value);
  if (error != ENOENT) return error;
  std::snprintf(name.data(), name.size(), "%s%s", kind, suffix);
  return read_number(folder_, name.data(), value);
}

void BufferDevice::close() noexcept {
  if (file_ < 0) return;
  ::close(file_);
  file_ = -1;
  (void)write_attribute(folder_, "buffer/enable", "0");
}

int BufferDevice::receive() noexcept {
  if (window_.bytes().size() >= layout_.scan_bytes()) return 0;
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

bool BufferDevice::next(InertialScan& scan) noexcept {
  if (window_.bytes().size() < layout_.scan_bytes()) return false;
  const std::span<const std::uint8_t> bytes = window_.bytes().first(layout_.scan_bytes());
  const auto value = [&](std::size_t channel) {
    const auto row = static_cast<Eigen::Index>(channel);
    return layout_.has(channel)
               ? (static_cast<double>(layout_.value(bytes, channel)) + offset_[row]) * scale_[row]
               : 0.0;
  };
  scan.gyro_rad_s = {value(0), value(1), value(2)};
  scan.accel_m_s2 = {value(3), value(4), value(5)};
  scan.time_ns = has_time() ? layout_.value(bytes, kTimestampChannel) : 0;
  window_.drop(layout_.scan_bytes());
  return true;
}

}  // namespace isobar::iio
