// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/forwarding.hpp"

#include <algorithm>

namespace isobar::bridge {
namespace {

using ipc::HealthLevel;
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// A thread comes round at least this often, so that its life can be seen.
constexpr auto kRound = 250ms;
/// isobard reports once a second; after this long the bridge says that it does not.
constexpr std::int64_t kMissingReportNs = 3'000'000'000;

std::int64_t steady_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// For messages that no sample of isobard's gives a time.
std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

HealthLevel warn_if(bool condition) { return condition ? HealthLevel::kWarning : HealthLevel::kOk; }

}  // namespace

void report_absence(dds::PoseOutputs& outputs, dds::DiagnosticsBuilder& builder) {
  builder.start(wall_ns());
  builder.add("bridge/isobard", HealthLevel::kError, "isobard is not running", 0.0);
  outputs.write_diagnostics(builder);
}

Forwarding::CloudsIn::CloudsIn()
    : scan(ipc::topics::kRegisteredScan), map(ipc::topics::kMapCloud), waiter({&scan.raw(), &map.raw()}) {}

Forwarding::Forwarding(dds::PoseOutputs& poses, dds::CloudOutputs& clouds, bool with_clouds)
    : poses_(poses),
      clouds_(clouds),
      prior_in_(ipc::topics::kPrior),
      pose_in_(ipc::topics::kPose),
      barometer_in_(ipc::topics::kBarometer),
      health_in_(ipc::topics::kHealth),
      pose_waiter_({&prior_in_.raw(), &pose_in_.raw(), &barometer_in_.raw(), &health_in_.raw()}),
      last_report_ns_(steady_ns()) {
  if (with_clouds) {
    clouds_in_.emplace();
  }
  pose_thread_ = std::thread([this] { forward_poses(); });
  if (with_clouds) {
    cloud_thread_ = std::thread([this] { forward_clouds(); });
  }
}

Forwarding::~Forwarding() {
  pose_waiter_.stop();
  pose_thread_.join();
  if (clouds_in_) {
    clouds_in_->waiter.stop();
    cloud_thread_.join();
  }
}

std::chrono::nanoseconds Forwarding::silence() const noexcept {
  const std::int64_t last_ns = last_data_ns_.load(std::memory_order_relaxed);
  return std::chrono::nanoseconds(last_ns == 0 ? 0 : steady_ns() - last_ns);
}

void Forwarding::note_data() noexcept { last_data_ns_.store(steady_ns(), std::memory_order_relaxed); }

void Forwarding::forward_poses() noexcept {
  while (pose_waiter_.wait_for(kRound) != ipc::Waiter::Event::kStopped) {
    rounds_.fetch_add(1, std::memory_order_relaxed);
    // Priors first: a pose needs the height that the altimeter had at its time.
    while (const auto prior = prior_in_.take()) {
      note_data();
      poses_.on_prior(*prior);
    }
    while (const auto pose = pose_in_.take()) {
      note_data();
      poses_.on_pose(*pose);
    }
    while (const auto sample = barometer_in_.take()) {
      poses_.on_pressure(*sample);
    }
    forward_health();
  }
}

void Forwarding::note_received(const ReceivedCounts& counts) noexcept {
  received_refused_.store(counts.refused, std::memory_order_relaxed);
  received_early_.store(counts.too_early, std::memory_order_relaxed);
}

void Forwarding::forward_health() {
  const auto report = health_in_.take_latest();
  if (!report && steady_ns() - last_report_ns_ < kMissingReportNs) {
    return;
  }
  last_report_ns_ = steady_ns();
  if (report) {
    note_data();
    clock_.note(report->stamp_ns);
    diagnostics_.start(report->stamp_ns);
    const std::uint32_t count = std::min(report->entry_count, ipc::HealthReport::kMaxEntries);
    for (std::uint32_t i = 0; i < count; ++i) {
      const ipc::HealthEntry& entry = report->entries[i];
      diagnostics_.add(entry.name, entry.level, entry.message, entry.value);
    }
  } else {
    diagnostics_.start(wall_ns());
    diagnostics_.add("bridge/isobard", HealthLevel::kStale, "isobard runs but says nothing", 0.0);
  }
  add_own_health();
  poses_.write_diagnostics(diagnostics_);
}

void Forwarding::add_own_health() {
  const auto add = [this](const char* name, std::uint64_t count, const char* message) {
    diagnostics_.add(name, warn_if(count > 0), count > 0 ? message : "", static_cast<double>(count));
  };
  const auto value = [](const std::atomic<std::uint64_t>& count) {
    return count.load(std::memory_order_relaxed);
  };
  add("bridge/samples_lost", prior_in_.dropped() + pose_in_.dropped(), "the bridge was too slow for isobard");
  add("bridge/clouds_lost", value(clouds_dropped_), "the bridge was too slow for isobard");
  add("bridge/messages_unsent", poses_.failures(), "a DDS reader is too slow");
  add("bridge/clouds_unsent", value(cloud_failures_), "a DDS reader is too slow");
  add("bridge/samples_refused", prior_in_.rejected() + pose_in_.rejected() + health_in_.rejected(),
      "isobard and isobar-dds are of different builds");
  add("bridge/received_implausible", value(received_refused_), "a DDS writer sends values that cannot be");
  add("bridge/received_too_early", value(received_early_), "came before isobard was ready for it");
}

void Forwarding::forward_clouds() noexcept {
  while (clouds_in_->waiter.wait_for(kRound) != ipc::Waiter::Event::kStopped) {
    if (const auto scan = clouds_in_->scan.take_latest()) {
      clouds_.on_scan(*scan);
    }
    if (const auto map = clouds_in_->map.take_latest()) {
      clouds_.on_map(*map);
    }
    clouds_dropped_.store(clouds_in_->scan.dropped(), std::memory_order_relaxed);
    cloud_failures_.store(clouds_.failures(), std::memory_order_relaxed);
  }
}

}  // namespace isobar::bridge
