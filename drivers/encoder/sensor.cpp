// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/encoder/sensor.hpp"

#include <algorithm>
#include <cerrno>

#include "core/plausibility.hpp"

namespace isobar::encoder {

Sensor::Sensor(const Settings& settings, std::unique_ptr<EdgeSource> source)
    : encoders_(settings.encoders()),
      geometry_(settings.geometry),
      period_ns_(1'000'000'000 / settings.rate_hz),
      source_(std::move(source)),
      place_("encoders on " + settings.chip),
      faults_(device_silence_ns(settings.rate_hz)) {}

int Sensor::file_descriptor() const noexcept { return open_ && !turns_ ? source_->file_descriptor() : -1; }

Device<WheelSample>::Step Sensor::step(std::int64_t now_ns) noexcept {
  Step step;
  if (open_) {
    measure(now_ns, step);
  } else {
    step.next_ns = begin(now_ns);
  }
  return step;
}

std::int64_t Sensor::begin(std::int64_t now_ns) noexcept {
  faults_.starts(now_ns);
  int error = source_->open();
  for (std::size_t i = 0; error == 0 && i < kMaxEncoders; ++i) {
    if (!encoders_[i].present()) continue;
    bool a = false;
    bool b = false;
    const auto encoder = static_cast<std::uint8_t>(i);
    error = source_->level(encoder, Line::kA, a);
    if (error == 0) error = source_->level(encoder, Line::kB, b);
    decoders_[i].start(a, b);
    last_counts_[i] = decoders_[i].count();
  }
  if (error != 0) {
    source_->close();
    ++faults_.counters().io_errors;
    const char* what = error == EBUSY ? "another program holds a line" : "the lines cannot be requested";
    return faults_.fail(DeviceState::kNoAnswer, what, now_ns, error);
  }
  open_ = true;
  turns_ = false;
  sorter_.clear();
  period_end_ns_ = source_->now_ns() + period_ns_;
  faults_.expects_results(now_ns);
  return now_ns + period_ns_;
}

void Sensor::measure(std::int64_t now_ns, Step& step) noexcept {
  const std::int64_t begun_ns = source_->now_ns();  // edges after this time may come in any order
  const std::size_t held_back = sorter_.size();
  if (const int error = source_->read(sorter_); error != 0) {
    open_ = false;
    source_->close();
    ++faults_.counters().io_errors;
    step.next_ns = faults_.fail(DeviceState::kNoAnswer, "the edges cannot be read", now_ns, error);
    return;
  }
  turns_ = sorter_.size() > held_back;
  const bool ends = begun_ns >= period_end_ns_;
  sorter_.release(ends ? period_end_ns_ : begun_ns, [this](const Edge& edge) {
    if (edge.encoder < kMaxEncoders) decoders_[edge.encoder].add(edge);
  });
  if (ends) take(now_ns - (begun_ns - period_end_ns_), step);
  step.sample.timing.received_ns = now_ns;
  // Not ahead after a late call: more periods have ended.
  const std::int64_t to_end_ns = period_end_ns_ - begun_ns;
  step.next_ns = now_ns + (turns_ ? std::min(to_end_ns, kReadEveryNs) : to_end_ns);
}

/// @param end_ns of the period, robot clock
void Sensor::take(std::int64_t end_ns, Step& step) noexcept {
  WheelSample sample =
      twist(geometry_, side_counts(0), side_counts(1), static_cast<double>(period_ns_) * 1e-9);
  sample.stamp_ns = end_ns - period_ns_ / 2;
  period_end_ns_ += period_ns_;
  std::uint64_t lost = source_->full_queues();
  for (std::size_t i = 0; i < kMaxEncoders; ++i) {
    last_counts_[i] = decoders_[i].count();
    lost += decoders_[i].counters().lost;
  }
  faults_.counters().corrupt = lost;
  if (implausibility(sample) != nullptr) {
    ++faults_.counters().implausible;
    // Said, and over with the next good sample; the lines stay open.
    (void)faults_.fail(DeviceState::kImplausible, "the wheels turn faster than any robot drives", end_ns);
    return;
  }
  faults_.good(end_ns);
  step.has_sample = true;
  step.sample = sample;
}

double Sensor::side_counts(std::size_t first) const noexcept {
  double sum = 0.0;
  int wheels = 0;
  for (std::size_t i = first; i < kMaxEncoders; i += 2) {
    if (!encoders_[i].present()) continue;
    sum += static_cast<double>(decoders_[i].count() - last_counts_[i]);
    ++wheels;
  }
  return wheels > 0 ? sum / wheels : 0.0;
}

}  // namespace isobar::encoder
