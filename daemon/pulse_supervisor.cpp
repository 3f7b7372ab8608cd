// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pulse_supervisor.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"

namespace isobar {

namespace {

using ipc::HealthLevel;

/// Time without a pulse that is silence [ns]: one may be late by the tick of the supervise loop.
constexpr std::int64_t kSilenceNs = 2'500'000'000;

std::unique_ptr<EdgeLine> line_of(const pps::Settings& settings) {
  if (!settings.present()) return nullptr;
  return std::make_unique<GpioLine>(settings.chip, static_cast<unsigned>(settings.line),
                                    GpioLine::Edges::kRising);
}

}  // namespace

PulseSupervisor::PulseSupervisor(const pps::Settings& settings)
    : PulseSupervisor(settings, line_of(settings)) {}

PulseSupervisor::PulseSupervisor(const pps::Settings& settings, std::unique_ptr<EdgeLine> line)
    : settings_(settings), input_(line ? std::make_unique<pps::PulseInput>(std::move(line)) : nullptr) {}

void PulseSupervisor::poll(const ClockPair& now) noexcept {
  if (!input_) return;
  input_->poll(now);
  polled_ns_ = now.monotonic_ns;
  if (since_ns_ == 0) since_ns_ = polled_ns_;
}

void PulseSupervisor::fill(ipc::HealthReport& report) {
  if (!input_ || since_ns_ == 0) return;
  const pps::PulseStatus status = input_->status();
  const pps::PulseFigures& figures = status.figures;
  const std::string where = fmt::format("{} line {}", settings_.chip, settings_.line);
  const std::int64_t silent_ns = polled_ns_ - std::max(figures.newest_ns, since_ns_);
  const double offset_ms = static_cast<double>(figures.offset_ns) * 1e-6;
  if (status.error != 0) {
    add_entry(report, "pps", HealthLevel::kWarning,
              fmt::format("{} cannot be read: {}", where, std::strerror(status.error)), 0.0);
  } else if (silent_ns > kSilenceNs) {
    add_entry(report, "pps", HealthLevel::kWarning,
              fmt::format("no pulse for {:.0f} s at {}", static_cast<double>(silent_ns) * 1e-9, where), 0.0);
  } else if (figures.newest_ns == 0) {
    add_entry(report, "pps", HealthLevel::kOk, "no pulse so far at " + where, 0.0);
  } else {
    const bool is_far = std::abs(offset_ms) > settings_.max_offset_ms;
    add_entry(report, "pps", is_far ? HealthLevel::kWarning : HealthLevel::kOk,
              fmt::format("system clock {:+.3f} ms against the second, jitter {:.1f} us, at {}{}", offset_ms,
                          figures.jitter_ns * 1e-3, where, is_far ? ": does chrony follow it?" : ""),
              offset_ms);
  }
  add_count(report, "pps/missing", figures.missing, last_.missing, "pulses missing between two others");
  add_count(report, "pps/extra", figures.extra, last_.extra, "edges between the pulses: noise at the line?");
  last_ = figures;
}

}  // namespace isobar
