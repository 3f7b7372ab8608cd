// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/live/report.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "drivers/clock/robot_clock.hpp"

namespace isobar::benchmark {
namespace {

/// Half of the shortest interval: scans 50 ms, IMU samples 2.5 ms.
constexpr std::int64_t kScanToleranceNs = 25'000'000;
constexpr std::int64_t kImuToleranceNs = 1'200'000;

/// Entries of the health report that are counters.
constexpr std::array<std::string_view, 17> kCounts{"lidar/deadline",
                                                   "prior/deadline",
                                                   "registration/deadline",
                                                   "map/deadline",
                                                   "registration/dropped",
                                                   "registration/refused",
                                                   "registration/bridged",
                                                   "registration/priors_dropped",
                                                   "map/dropped",
                                                   "lidar/packets_lost",
                                                   "lidar/dropped_by_kernel",
                                                   "lidar/no_memory",
                                                   "lidar/reordered",
                                                   "input/dropped_by_kernel",
                                                   "input/dropped",
                                                   "input/no_memory",
                                                   "registration/page_faults"};

std::vector<Event> within(const std::vector<Event>& events, const Reading& before, const Reading& after) {
  std::vector<Event> result;
  for (const Event& event : events) {
    if (event.at_ns >= before.at_ns && event.at_ns < after.at_ns) result.push_back(event);
  }
  return result;
}

std::map<std::string, Load> loads(const std::map<std::string, ThreadTimes>& before,
                                  const std::map<std::string, ThreadTimes>& after, double seconds) {
  std::map<std::string, ThreadTimes> grown;
  for (const auto& [name, times] : after) {
    const auto known = before.find(name);
    const ThreadTimes start = known == before.end() ? ThreadTimes{} : known->second;
    const ThreadTimes difference{times.running_ns - start.running_ns, times.waiting_ns - start.waiting_ns,
                                 times.turns - start.turns};
    for (ThreadTimes* sum : {&grown[name], &grown["all"]}) {
      sum->running_ns += difference.running_ns;
      sum->waiting_ns += difference.waiting_ns;
      sum->turns += difference.turns;
    }
  }
  std::map<std::string, Load> result;
  for (const auto& [name, times] : grown) {
    Load& load = result[name];
    load.cpu_percent = static_cast<double>(times.running_ns) * 1e-7 / seconds;
    load.turns_per_second = static_cast<double>(times.turns) / seconds;
    if (times.turns > 0) {
      load.mean_run_delay_ms =
          static_cast<double>(times.waiting_ns) * 1e-6 / static_cast<double>(times.turns);
    }
  }
  return result;
}

struct Target {
  std::string name;
  double value;
  double most;
};

std::vector<Target> targets_of(const PhaseResult& result) {
  const bool idle = result.name == "idle";
  std::vector<Target> targets;
  if (idle) targets.push_back({"pose over DDS, median ms", result.pose_dds.median_ms, 5.0});
  targets.push_back({"pose over DDS, p99 ms", result.pose_dds.p99_ms, idle ? 15.0 : 50.0});
  targets.push_back({"isobard, % of a core", result.isobard.at("all").cpu_percent, 5.0});
  targets.push_back({"scans dropped", result.counts.at("registration/dropped"), 0.0});
  targets.push_back({"poses lost", static_cast<double>(result.poses_lost), 0.0});
  return targets;
}

std::string latency_row(const char* what, const Summary& summary) {
  if (summary.count == 0) return {};  // no subscriber
  return fmt::format("  {:<44} {:>8.2f} {:>8.2f} {:>8.2f}  of {}\n", what, summary.median_ms, summary.p99_ms,
                     summary.max_ms, summary.count);
}

std::string load_rows(const char* program, const std::map<std::string, Load>& all) {
  std::string text;
  for (const auto& [name, load] : all) {
    if (name != "all" && load.turns_per_second < 0.5) continue;
    text += fmt::format("  {:<11} {:<32} {:>8.2f} {:>8.1f} {:>10.3f}\n", program, name, load.cpu_percent,
                        load.turns_per_second, load.mean_run_delay_ms);
  }
  return text;
}

std::string json_of(const Summary& summary) {
  return fmt::format(R"({{"count": {}, "median_ms": {:.4f}, "p99_ms": {:.4f}, "max_ms": {:.4f}}})",
                     summary.count, summary.median_ms, summary.p99_ms, summary.max_ms);
}

std::string json_of(const std::map<std::string, Load>& all) {
  std::string text;
  for (const auto& [name, load] : all) {
    text += fmt::format(
        R"({}"{}": {{"cpu_percent": {:.4f}, "turns_per_second": {:.2f}, "mean_run_delay_ms": {:.5f}}})",
        text.empty() ? "" : ", ", name, load.cpu_percent, load.turns_per_second, load.mean_run_delay_ms);
  }
  return "{" + text + "}";
}

std::string json_of(const std::map<std::string, double>& counts) {
  std::string text;
  for (const auto& [name, value] : counts) {
    text += fmt::format(R"({}"{}": {})", text.empty() ? "" : ", ", name, value);
  }
  return "{" + text + "}";
}

std::string json_of(const PhaseResult& result) {
  return fmt::format(
      R"({{"phase": "{}", "seconds": {:.3f}, "scans_sent": {}, "poses_lost": {},
  "last_packet_to_pose_over_dds": {},
  "last_packet_to_pose_in_shared_memory": {},
  "last_packet_to_scan_in_shared_memory": {},
  "imu_datagram_to_prior_in_shared_memory": {},
  "wake_up_of_another_process": {},
  "isobard": {},
  "isobar_dds": {},
  "isobard_resident_mb": {:.1f}, "isobar_dds_resident_mb": {:.1f},
  "counts": {}}})",
      result.name, result.seconds, result.scans_sent, result.poses_lost, json_of(result.pose_dds),
      json_of(result.pose_memory), json_of(result.scan_memory), json_of(result.prior_memory),
      json_of(result.wake_up), json_of(result.isobard), json_of(result.bridge), result.isobard_memory.now_mb,
      result.bridge_memory.now_mb, json_of(result.counts));
}

}  // namespace

Reading read(const Programs& programs, const MemoryListener& memory) {
  Reading reading;
  reading.health = memory.events().health;
  reading.isobard = thread_times(programs.isobard);
  reading.bridge = thread_times(programs.bridge);
  reading.isobard_memory = resident_memory(programs.isobard);
  reading.bridge_memory = resident_memory(programs.bridge);
  reading.at_ns = RobotClock::now_ns();
  return reading;
}

PhaseResult evaluate(const std::string& name, const Reading& before, const Reading& after,
                     const Sender& sender, const PoseListener& poses, const MemoryListener& memory) {
  PhaseResult result;
  result.name = name;
  result.seconds = static_cast<double>(after.at_ns - before.at_ns) * 1e-9;
  const std::vector<Event> scans = within(sender.scans(), before, after);
  const std::vector<Event> samples = within(sender.imu_samples(), before, after);
  const MemoryEvents seen = memory.events();
  result.scans_sent = scans.size();
  const Matched over_dds = match(scans, poses.poses(), kScanToleranceNs);
  result.poses_lost = over_dds.lost;
  result.pose_dds = summary_of(over_dds.latencies_ns);
  result.pose_memory = summary_of(match(scans, seen.poses, kScanToleranceNs).latencies_ns);
  result.scan_memory = summary_of(match(scans, seen.scans, kScanToleranceNs).latencies_ns);
  result.prior_memory = summary_of(match(samples, seen.priors, kImuToleranceNs).latencies_ns);
  std::vector<std::int64_t> wake_ups_ns;
  for (const Event& event : within(seen.wake_ups, before, after))
    wake_ups_ns.push_back(event.at_ns - event.stamp_ns);
  result.wake_up = summary_of(std::move(wake_ups_ns));
  result.isobard = loads(before.isobard, after.isobard, result.seconds);
  result.bridge = loads(before.bridge, after.bridge, result.seconds);
  result.isobard_memory = after.isobard_memory;
  result.bridge_memory = after.bridge_memory;
  const auto value = [](const Reading& reading, const std::string& entry) {
    const auto found = reading.health.find(entry);
    return found == reading.health.end() ? 0.0 : found->second;
  };
  for (const std::string_view entry : kCounts) {
    const std::string key(entry);
    result.counts[key] = value(after, key) - value(before, key);
  }
  return result;
}

std::string table(const std::vector<PhaseResult>& results) {
  std::string text;
  for (const PhaseResult& result : results) {
    text += fmt::format("{}, {:.0f} s, {} scans\n", result.name, result.seconds, result.scans_sent);
    text += fmt::format("  {:<44} {:>8} {:>8} {:>8}\n", "latency [ms]", "median", "p99", "max");
    text += latency_row("last packet to pose over DDS", result.pose_dds);
    text += latency_row("last packet to pose in shared memory", result.pose_memory);
    text += latency_row("last packet to scan in shared memory", result.scan_memory);
    text += latency_row("IMU datagram to prior in shared memory", result.prior_memory);
    text += latency_row("registered scan handed over to another awake", result.wake_up);
    text += fmt::format("  {:<44} {:>8} {:>8} {:>10}\n", "thread", "% core", "turns/s", "delay ms");
    text += load_rows("isobard", result.isobard) + load_rows("isobar-dds", result.bridge);
    text += fmt::format("  resident: isobard {:.0f} MB, isobar-dds {:.0f} MB\n", result.isobard_memory.now_mb,
                        result.bridge_memory.now_mb);
    for (const auto& [name, count] : result.counts) {
      if (count != 0.0) text += fmt::format("  {:<44} {:>8.0f}\n", name, count);
    }
    for (const Target& target : targets_of(result)) {
      text += fmt::format("  {:<44} {:>8.2f}  at most {}: {}\n", target.name, target.value, target.most,
                          target.value <= target.most ? "met" : "MISSED");
    }
  }
  return text;
}

std::string json(const std::vector<PhaseResult>& results) {
  std::string text;
  for (const PhaseResult& result : results) text += (text.empty() ? "" : ",\n") + json_of(result);
  return "[" + text + "]\n";
}

bool targets_met(const std::vector<PhaseResult>& results) {
  for (const PhaseResult& result : results) {
    for (const Target& target : targets_of(result)) {
      if (target.value > target.most) return false;
    }
  }
  return true;
}

}  // namespace isobar::benchmark
