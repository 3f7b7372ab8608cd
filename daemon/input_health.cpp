// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/input_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <string_view>

#include "core/stamp.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;

bool is_recent(std::int64_t then_ns, std::int64_t now_ns) {
  return then_ns != 0 && now_ns - then_ns < kSenderMemoryNs;
}

std::string text_of(const SenderAddress& sender, bool with_port) {
  const std::string address = ipv4_text(sender.ipv4);
  return with_port ? address + ":" + std::to_string(sender.port) : address;
}

std::string_view text_of(SamplePath path) {
  return path == SamplePath::kDatagram ? "datagrams" : path == SamplePath::kDds ? "DDS" : "this machine";
}

}  // namespace

void add_senders(ipc::HealthReport& report, const std::string& name, const SenderStatus& status,
                 std::int64_t now_ns, const char* remedy) {
  if (status.refused == 0 && status.takeovers == 0) return;
  const bool same_address = status.other.ipv4 == status.in_use.ipv4;
  const std::string in_use = text_of(status.in_use, same_address);
  const std::string other = text_of(status.other, same_address);
  if (is_recent(status.other_ns, now_ns) && status.in_use.ipv4 == 0) {
    add_entry(report, name + "/senders", HealthLevel::kError,
              fmt::format("{} sends, but is not the configured sender: refused; {}", other, remedy),
              static_cast<double>(status.refused));
  } else if (is_recent(status.other_ns, now_ns)) {
    add_entry(report, name + "/senders", HealthLevel::kWarning,
              fmt::format("{} is used, {} sends, too: refused; {}", in_use, other, remedy),
              static_cast<double>(status.refused));
  } else if (is_recent(status.takeover_ns, now_ns)) {
    add_entry(report, name + "/senders", HealthLevel::kWarning,
              fmt::format("{} is used from now on: the sender before it fell silent", in_use),
              static_cast<double>(status.takeovers));
  } else {
    add_entry(report, name + "/senders", HealthLevel::kOk,
              fmt::format("{} alone sends; refused from others so far: {}", in_use, status.refused),
              static_cast<double>(status.refused));
  }
}

void add_sample_senders(ipc::HealthReport& report, const SampleInputStatus& now,
                        const SampleInputStatus& before, std::int64_t now_ns) {
  constexpr std::array<const char*, datagram::kKinds> kNames = {"imu", "barometer", "base_station", "wheels"};
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    add_senders(report, kNames[kind], now.senders[kind], now_ns,
                "stop one of them, or name it in input.senders");
  }
  if (now.not_allowed == 0) return;
  add_entry(report, "input/not_allowed",
            now.not_allowed > before.not_allowed ? HealthLevel::kWarning : HealthLevel::kOk,
            "datagrams refused: input.senders does not name " + ipv4_text(now.not_allowed_ipv4),
            static_cast<double>(now.not_allowed));
}

void add_paths(ipc::HealthReport& report, const std::string& name, const PathStatus& status,
               std::int64_t now_ns) {
  if (status.refused == 0 && status.takeovers == 0) return;
  const auto refused = static_cast<double>(status.refused);
  const SamplePath other = status.in_use == SamplePath::kDds ? SamplePath::kDatagram : SamplePath::kDds;
  if (is_recent(status.other_ns, now_ns)) {
    add_entry(report, name + "/paths", HealthLevel::kWarning,
              fmt::format("a second sender, over {}: refused; the one over {} is used", text_of(other),
                          text_of(status.in_use)),
              refused);
  } else {
    add_entry(report, name + "/paths", HealthLevel::kOk,
              fmt::format("the one over {} is used", text_of(status.in_use)), refused);
  }
}

void add_system_clock(ipc::HealthReport& report, const SystemClockWatch& system, std::int64_t now_ns) {
  if (system.steps() == 0) {
    add_entry(report, "system_clock", HealthLevel::kOk, "not set since the start", 0.0);
    return;
  }
  add_entry(report, "system_clock",
            is_recent(system.stepped_ns(), now_ns) ? HealthLevel::kWarning : HealthLevel::kOk,
            fmt::format("set {} times since the start, by {} the last time; published stamps follow it",
                        system.steps(), duration_text(system.last_step_ns())),
            static_cast<double>(system.steps()));
}

std::string waiting_for(const DeviceThreadStatus& sensor) {
  const DeviceState state = sensor.device.state;
  const bool waits = state == DeviceState::kNoAnswer || state == DeviceState::kWrongDevice;
  if (!sensor.present || !waits) return {};
  return std::string(sensor.place.data()) + ": " + sensor.device.fault.data();
}

void add_starts_over(ipc::HealthReport& report, const StartOver& start_over, std::int64_t now_ns) {
  if (start_over.count() == 0) return;
  add_entry(
      report, "input/starts_over",
      is_recent(start_over.last_ns(), now_ns) ? HealthLevel::kWarning : HealthLevel::kOk,
      "the lidar's clock jumped and the IMU began anew, together: another recording; a new map frame began",
      static_cast<double>(start_over.count()));
}

std::string duration_text(std::int64_t duration_ns) {
  constexpr std::int64_t kDayS = 86'400;
  const double s = std::abs(seconds_between(0, duration_ns));
  const char sign = duration_ns < 0 ? '-' : '+';
  if (s < 60.0) return fmt::format("{}{:.3f} s", sign, s);
  const std::int64_t whole = std::llround(s);
  return fmt::format("{}{} days {:02}:{:02}:{:02}", sign, whole / kDayS, whole / 3600 % 24, whole / 60 % 60,
                     whole % 60);
}

std::string step_text(std::int64_t step_ns) {
  return fmt::format(
      "the system clock was set by {}: stamps that are published follow it from now on, the estimator's own "
      "do "
      "not",
      duration_text(step_ns));
}

}  // namespace isobar
