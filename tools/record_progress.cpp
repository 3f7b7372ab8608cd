// SPDX-License-Identifier: BSD-3-Clause
#include "tools/record_progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace isobar::tools {
namespace {

constexpr std::int64_t kPipePeriodNs = 10'000'000'000;
constexpr double kBytesPerMb = 1e6;

}  // namespace

RecordProgress::RecordProgress() : terminal_(isatty(STDERR_FILENO) == 1) {}

RecordProgress::~RecordProgress() { end_line(); }

void RecordProgress::end_line() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

void RecordProgress::update(const RecordFigures& now) {
  if (started_ns_ == 0) {
    started_ns_ = now.now_ns;
    last_ = now;
  }
  const std::int64_t elapsed_ns = now.now_ns - last_.now_ns;
  if (!terminal_ && elapsed_ns < kPipePeriodNs) return;
  const double elapsed_s = std::max(1e-3, static_cast<double>(elapsed_ns) * 1e-9);
  const auto rate = [elapsed_s](std::uint64_t count, std::uint64_t before) {
    return static_cast<double>(count - before) / elapsed_s;
  };
  std::fprintf(stderr,
               "%s%.0f s  per second: %.0f %s, %.0f imu, %.0f barometer, %.0f base, %.0f wheel  "
               "%.1f MB, %.0f MB free, %llu lost%s",
               terminal_ ? "\r\033[K" : "", static_cast<double>(now.now_ns - started_ns_) * 1e-9,
               rate(now.counts.packets + now.counts.clouds, last_.counts.packets + last_.counts.clouds),
               now.counts.clouds > 0 ? "clouds" : "packets", rate(now.counts.imu, last_.counts.imu),
               rate(now.counts.pressure, last_.counts.pressure),
               rate(now.counts.base_pressure, last_.counts.base_pressure),
               rate(now.counts.wheel, last_.counts.wheel), static_cast<double>(now.bytes) / kBytesPerMb,
               static_cast<double>(now.free_bytes) / kBytesPerMb, static_cast<unsigned long long>(now.lost),
               terminal_ ? "" : "\n");
  std::fflush(stderr);
  line_open_ = terminal_;
  last_ = now;
}

}  // namespace isobar::tools
