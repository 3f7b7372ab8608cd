// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/forwarding.hpp"

#include <algorithm>
#include <cstring>

#include "daemon/base_station_health.hpp"
#include "daemon/bridge/floor_health.hpp"
#include "daemon/bridge/key_health.hpp"
#include "daemon/bridge/steady_time.hpp"
#include "daemon/logging.hpp"
#include "drivers/clock/robot_clock.hpp"

namespace isobar::bridge {
namespace {

using ipc::HealthLevel;
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Longest wait of a thread, so that rounds() of an idle pose thread still advances.
constexpr auto kMaxWait = 250ms;
/// Time without a health report after which the diagnostics report its absence [ns]: three periods of 1 s.
constexpr std::int64_t kMissingReportNs = 3'000'000'000;
/// Time without a reader after which the map cloud is no longer received [ns].
constexpr std::int64_t kMapKeptNs = 20'000'000'000;

/// Stamp of diagnostics without a health report of isobard to take it from.
std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

void append(const ipc::HealthReport& from, ipc::HealthReport& to) {
  const std::uint32_t count = std::min(from.entry_count, ipc::HealthReport::kMaxEntries);
  for (std::uint32_t i = 0; i < count; ++i) {
    const ipc::HealthEntry& entry = from.entries[i];
    static_cast<void>(to.add(entry.name, entry.level, entry.message, entry.value));
  }
}

HealthLevel warn_if(bool condition) { return condition ? HealthLevel::kWarning : HealthLevel::kOk; }

}  // namespace

void report_absence(Outputs& outputs, dds::DiagnosticsBuilder& builder) {
  builder.start(wall_ns());
  builder.add(ipc::HealthReport::kSummaryName.data(), HealthLevel::kError, "isobard is not running", 1.0);
  builder.add("bridge/isobard", HealthLevel::kError, "isobard is not running", 0.0);
  if (outputs.diagnostics) outputs.diagnostics->write(builder.message());
}

Forwarding::CloudsIn::CloudsIn() : scan(ipc::topics::kRegisteredScan), waiter({&scan.raw()}) {}

Forwarding::Forwarding(Outputs& outputs, const dds::DdsConfig& config)
    : outputs_(outputs),
      prior_in_(ipc::topics::kPrior),
      pose_in_(ipc::topics::kPose),
      station_in_(ipc::topics::kBaseBarometer),
      health_in_(ipc::topics::kHealth),
      pose_waiter_({&prior_in_.raw(), &pose_in_.raw(), &station_in_.raw(), &health_in_.raw()}),
      last_report_ns_(steady_ns()) {
  configure(config);
  set_floors(outputs.floors.has_value());
  pose_thread_ = std::thread([this] { forward_poses(); });
  set_clouds(outputs.clouds.has_value());
}

Forwarding::~Forwarding() { stop(); }

void Forwarding::stop() {
  pose_waiter_.stop();
  if (pose_thread_.joinable()) pose_thread_.join();
  set_clouds(false);
  set_floors(false);
}

void Forwarding::set_floors(bool are_published) {
  if (are_published == floors_.has_value()) return;
  const std::lock_guard lock(pose_mutex_);  // the pose thread reads its state
  if (!are_published) return floors_.reset();
  floors_.emplace(*outputs_.floors, stamp_shift_ns_);
}

void Forwarding::configure(const dds::DdsConfig& config) {
  const auto topic = [&config](const std::string& station) {
    return dds::dds_name(dds::topics::kBasePressure, station, config.topics.base_pressure).substr(3);
  };
  station_topics_ = {topic(config.base_station), topic(config.second_base_station)};
  diagnostics_.emplace(config.node_name);
}

void Forwarding::set_clouds(bool are_published) {
  if (are_published == clouds_in_.has_value()) return;
  if (are_published) {
    clouds_in_.emplace();
    cloud_thread_ = std::thread([this] { forward_clouds(); });
    return;
  }
  clouds_in_->waiter.stop();
  cloud_thread_.join();
  clouds_in_.reset();
}

std::chrono::nanoseconds Forwarding::silence() const noexcept {
  const std::int64_t last_ns = last_data_ns_.load(std::memory_order_relaxed);
  return std::chrono::nanoseconds(last_ns == 0 ? 0 : steady_ns() - last_ns);
}

void Forwarding::note_data() noexcept { last_data_ns_.store(steady_ns(), std::memory_order_relaxed); }

// Published stamps follow the system clock, which consumers compare them with; isobard's own never jump.
void Forwarding::follow_system_clock() noexcept {
  if (!system_clock_) return;
  system_clock_->note(read_clocks());
  const std::int64_t shift_ns = system_clock_->ahead_ns();
  stamp_shift_ns_.store(shift_ns, std::memory_order_relaxed);
  if (outputs_.poses) outputs_.poses->set_stamp_shift_ns(shift_ns);
}

void Forwarding::forward_poses() noexcept {
  while (pose_waiter_.wait_for(kMaxWait) != ipc::Waiter::Event::kStopped) {
    rounds_.fetch_add(1, std::memory_order_relaxed);
    const std::lock_guard lock(pose_mutex_);
    forward_round();
  }
}

void Forwarding::forward_round() {
  forward_health();  // first: it tells isobard's clock, on which all stamps are
  follow_system_clock();
  // Priors first: a pose needs the altimeter's height at its stamp.
  while (const auto prior = prior_in_.take()) {
    note_data();
    if (outputs_.poses) outputs_.poses->on_prior(*prior);
  }
  while (const auto pose = pose_in_.take()) {
    note_data();
    if (outputs_.poses) outputs_.poses->on_pose(*pose);
  }
  while (const auto sample = station_in_.take()) {
    if (outputs_.station) {
      outputs_.station->on_pressure(*sample, stamp_shift_ns_.load(std::memory_order_relaxed));
    }
  }
}

void Forwarding::put_network(NetworkState state) {
  const std::lock_guard lock(pose_mutex_);
  network_ = std::move(state);
}

void Forwarding::put_inputs(std::vector<InputState> states) {
  const std::lock_guard lock(pose_mutex_);
  inputs_ = std::move(states);
}

void Forwarding::put_received(const ReceivedCounts& counts) noexcept { received_.put(counts); }

void Forwarding::put_keys(const KeyStatus& status) noexcept { keys_.put(status); }

void Forwarding::forward_health() {
  const auto report = health_in_.take_latest();
  if (!report && steady_ns() - last_report_ns_ < kMissingReportNs) {
    return;
  }
  last_report_ns_ = steady_ns();
  own_.entry_count = all_.entry_count = 0;
  if (report) {
    note_data();
    clock_.set_offset_ns(report->robot_clock_offset_ns);
    if (!system_clock_) system_clock_.emplace(report->robot_clock_offset_ns);
    follow_system_clock();
    diagnostics_->start(report->stamp_ns + stamp_shift_ns_.load(std::memory_order_relaxed));
    const bool has_summary =
        report->entry_count > 0 && ipc::HealthReport::kSummaryName == report->entries[0].name;
    if (!has_summary) reserve_summary(all_);
    append(*report, all_);
    last_entries_.assign(all_.entries + 1, all_.entries + all_.entry_count);  // without the summary
  } else {
    diagnostics_->start(wall_ns());
    reserve_summary(all_);
    static_cast<void>(all_.add("bridge/isobard", HealthLevel::kStale, "isobard sends no health report", 0.0));
    // What was said last is no longer known: a name that only vanished would stay green in many a display.
    for (const ipc::HealthEntry& entry : last_entries_) {
      static_cast<void>(all_.add(entry.name, HealthLevel::kStale, entry.message, entry.value));
    }
  }
  add_own_health();
  hold_.apply(last_report_ns_, own_);
  log_own_health();
  append(own_, all_);
  // Not among the own entries: the network has its own log lines.
  static_cast<void>(all_.add("bridge/network", network_.level, network_.message, 0.0));
  fill_summary(all_);
  for (std::uint32_t i = 0; i < all_.entry_count; ++i) {
    const ipc::HealthEntry& entry = all_.entries[i];
    diagnostics_->add(entry.name, entry.level, entry.message, entry.value);
  }
  if (outputs_.diagnostics) outputs_.diagnostics->write(diagnostics_->message());
}

void Forwarding::add(const std::string& name, HealthLevel level, const std::string& message, double value) {
  static_cast<void>(own_.add(name, level, message, value));
}

void Forwarding::log_own_health() {
  for (std::uint32_t i = 0; i < own_.entry_count; ++i) {
    const ipc::HealthEntry& entry = own_.entries[i];
    const auto change = changes_.note(entry.name, entry.level, entry.message, last_report_ns_, entry.value);
    if (change) log_change(*change);
  }
}

void Forwarding::add_own_health() {
  const auto add_count = [this](const char* name, std::uint64_t count, const char* message) {
    std::uint64_t& before = last_counts_[name];
    add(name, warn_if(count > before), count > 0 ? message : "", static_cast<double>(count));
    before = count;
  };
  const auto value = [](const std::atomic<std::uint64_t>& count) {
    return count.load(std::memory_order_relaxed);
  };
  const std::uint64_t unsent = (outputs_.diagnostics ? outputs_.diagnostics->failures() : 0) +
                               (outputs_.poses ? outputs_.poses->failures() : 0) +
                               (outputs_.station ? outputs_.station->failures() : 0);
  const ReceivedCounts received = received_.get();
  const FloorState floors = floors_ ? floors_->state() : FloorState{};
  add_count("bridge/samples_lost", prior_in_.dropped() + pose_in_.dropped() + station_in_.dropped(),
            "isobar-dds is slower than isobard");
  add_count("bridge/clouds_lost", value(clouds_dropped_) + floors.lost, "isobar-dds is slower than isobard");
  add_count("bridge/messages_unsent", unsent, "a DDS reader is too slow");
  add_count("bridge/clouds_unsent", value(cloud_failures_) + floors.unsent, "a DDS reader is too slow");
  add_count("bridge/samples_refused",
            prior_in_.rejected() + pose_in_.rejected() + station_in_.rejected() + health_in_.rejected() +
                floors.rejected,
            "isobard and isobar-dds come from different builds");
  add_count("bridge/floors_refused", floors.refused, "implausible grids of floors");
  add_count("bridge/received_implausible", received.refused, "a DDS writer sends implausible values");
  add_count("bridge/received_other_senders", received.other_senders,
            "a second node writes the topic of the IMU or of the wheels: refused; stop one of them");
  add_count("bridge/initial_pose_refused", received.refused_hints.count, received.refused_hints.rule);
  add_count("bridge/shared_memory_faults", ipc::library_fault_count(), "errors in the iceoryx library");
  add_count("bridge/received_too_early", received.too_early, "received before isobard could take it");
  add_input_health();
  add_station_health(received);
  const AddEntry add_entry = [this](const auto&... entry) { add(entry...); };
  add_floor_health(floors, add_entry);
  add_key_health(keys_.get(), add_entry);
}

void Forwarding::add_input_health() {
  for (const InputState& state : inputs_) {
    add(std::string("bridge/") + state.input + "_writer", warn_if(!state.trouble.empty()), state.trouble,
        0.0);
  }
}

void Forwarding::add_station_health(const ReceivedCounts& received) {
  static constexpr std::array<const char*, 2> kNames{"bridge/base_station", "bridge/second_base_station"};
  const AddEntry to_diagnostics = [this](const std::string& name, HealthLevel level,
                                         const std::string& message,
                                         double value) { add(name, level, message, value); };
  for (std::size_t i = 0; i < received.station_count; ++i) {
    // The first one may as well send datagrams to isobard, whose own entry tells whether it is missing.
    add_base_station_state(kNames[i], received.stations[i], received.taken_ns, station_topics_[i],
                           to_diagnostics, i > 0);
    add_base_station_counts(kNames[i], received.stations[i], last_received_.stations[i], to_diagnostics);
  }
  last_received_ = received;
}

void Forwarding::forward_clouds() noexcept {
  while (clouds_in_->waiter.wait_for(kMaxWait) != ipc::Waiter::Event::kStopped) {
    const std::lock_guard lock(cloud_mutex_);
    if (const auto scan = clouds_in_->scan.take_latest()) {
      outputs_.clouds->on_scan(*scan, stamp_shift_ns_.load(std::memory_order_relaxed));
    }
    clouds_dropped_.store(clouds_in_->scan.dropped(), std::memory_order_relaxed);
    cloud_failures_.store(outputs_.clouds->failures(), std::memory_order_relaxed);
    follow_map_readers();
    if (!clouds_in_->map) continue;
    while (const auto piece = clouds_in_->map->take())
      outputs_.clouds->on_map(*piece, stamp_shift_ns_.load(std::memory_order_relaxed));
  }
}

// A reader that has gone may only be renewing its network: its map is kept for a while.
void Forwarding::follow_map_readers() {
  CloudsIn& in = *clouds_in_;
  if (outputs_.clouds->map_has_readers()) {
    in.map_read_ns = steady_ns();
    if (!in.map) in.map.emplace(ipc::topics::kMapCloud);
  } else if (in.map && steady_ns() - in.map_read_ns > kMapKeptNs) {
    in.map.reset();
    outputs_.clouds->forget_map();
  }
}

}  // namespace isobar::bridge
