// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

void add_priority(const char* name, int& priority, const char* doc, SectionBuilder& section) {
  section.number(name, &priority, "", 1, 99, doc);
}

void add_cpus(const char* name, std::vector<int>& cpus, const char* doc, SectionBuilder& section) {
  section.number(name, &cpus, "", 0, 1'023, doc);
}

void add_scheduling(RealtimeSettings& realtime, SectionBuilder& s) {
  s.used_by(UsedBy::kEveryRole);
  s.flag("enabled", realtime.enabled,
         "Real-time scheduling: SCHED_FIFO, and all memory locked in RAM. Needs privileges; without them "
         "isobard runs with ordinary scheduling and logs it.");
  add_priority("inertial_priority", realtime.inertial_priority,
               "SCHED_FIFO priority of the thread that receives samples. Highest: IMU samples are the most "
               "frequent and the cheapest work.",
               s);
  add_cpus("estimator_cpus", realtime.estimator_cpus,
           "Processor cores of the threads lidar, inertial, prior and registration. Empty: all.", s);
  s.used_by(UsedBy::kRobot);
  add_priority("prior_priority", realtime.prior_priority,
               "SCHED_FIFO priority of the prior thread. As the samples': the prior is due with each of "
               "them.",
               s);
  add_priority("lidar_priority", realtime.lidar_priority,
               "SCHED_FIFO priority of the lidar thread. Above the registration: packets keep coming while "
               "it computes.",
               s);
  add_priority("registration_priority", realtime.registration_priority,
               "SCHED_FIFO priority of the registration thread. Lowest: it computes longest.", s);
  add_cpus("map_cpus", realtime.map_cpus, "Processor cores of the map thread. Empty: all.", s);
}

void add_deadline(const char* name, double& limit_ms, const char* doc, SectionBuilder& section) {
  section.number(name, &limit_ms, "ms", 0.1, 10'000.0, doc);
}

// With the defaults one map update in 650 was late beside `stress-ng --cpu 4`, and nothing else
// (tests/benchmark/live).
void add_deadlines(RealtimeSettings& realtime, SectionBuilder& s) {
  s.applies(Apply::kLive);
  add_deadline("lidar_deadline_ms", realtime.lidar_deadline_ms,
               "Deadline from the end of a scan to its hand-over to the registration. Misses are counted and "
               "shown in the diagnostics. 10: the packet that shows the end comes up to 3 ms after it.",
               s);
  add_deadline("prior_deadline_ms", realtime.prior_deadline_ms,
               "Deadline from an IMU sample to the prior that includes it. 10: two samples at 200 Hz.", s);
  add_deadline("registration_deadline_ms", realtime.registration_deadline_ms,
               "Deadline from the end of a scan to its pose. 50: leaves half of a scan's time at 10 Hz to "
               "the consumers of the pose.",
               s);
  add_deadline("map_deadline_ms", realtime.map_deadline_ms,
               "Deadline from a pose to the map that includes its scan. 100: one scan at 10 Hz, so that the "
               "next scan but one is matched to that map.",
               s);
  s.number("prior_reach_ms", &realtime.prior_reach_ms, "ms", 0.0, 100.0,
           "Largest age of the newest prior at the end of a scan with which the scan is registered at once. "
           "6: one sample at 200 Hz, over which a constant twist predicts a turn to 0.1 mrad.");
  s.number("prior_wait_ms", &realtime.prior_wait_ms, "ms", 1.0, 1'000.0,
           "Longest wait of a scan for a prior that is young enough (prior_reach_ms); after it the scan is "
           "registered without. 50: before the next scan at 10 Hz arrives.");
}

void add_input(InputSettings& input, std::vector<Setting>& settings) {
  SectionBuilder s("input", UsedBy::kEveryRole, settings);
  s.text("address", input.address, TextRule::kIpv4,
         "IPv4 address on which samples are received. 127.0.0.1: from programs of this machine only. For a "
         "sender in the network, the address of the interface, or 0.0.0.0 for all of them.");
  s.text("senders", input.senders, TextRule::kIpv4List,
         "IPv4 addresses whose sample datagrams are taken, separated by commas. Empty: any. In either case "
         "each stream (imu, baro, base, wheel) is taken from one sender at a time, the first heard.");
  s.number("port", &input.port, "", 1, 65'535,
           "UDP port of the sample datagrams. Must differ from lidar.port.");
  s.used_by(UsedBy::kRobot);
  s.flag(
      "expect_wheels", input.expect_wheels,
      "This robot has wheel odometry. true: its absence is shown as a fault. false: wheels that were never "
      "heard are \"none\"; once heard, their silence is a fault.");
  s.flag(
      "expect_base_station", input.expect_base_station,
      "This robot has a base station. true: its absence is shown as a fault. false: a base station that was "
      "never heard is \"none\", and a height that drifts with the weather is no warning.");
}

void add_pps(pps::Settings& pps, std::vector<Setting>& settings) {
  SectionBuilder s("pps", UsedBy::kEveryRole, settings);
  s.text("chip", pps.chip, TextRule::kAny,
         "GPIO chip of the line with the pulse. isobard needs the right to open it.");
  s.number("line", &pps.line, "", -1, 511,
           "Line of the chip on which a receiver (GNSS, PTP clock) raises a pulse at every whole second. The "
           "kernel "
           "stamps its edges; the offset of the system clock, the jitter and missing pulses are in the entry "
           "pps of "
           "the health report. The clock itself is set by chrony. -1: no such line.");
  s.number("max_offset_ms", &pps.max_offset_ms, "ms", 0.001, 500.0,
           "Offset of the system clock against the second beyond which pps is a warning. 1: a hundredth of a "
           "scan at 10 Hz, and more than chrony leaves with any pulse.");
}

void add_output(OutputSettings& output, std::vector<Setting>& settings) {
  SectionBuilder s("output", UsedBy::kRobot, settings);
  s.text("directory", output.directory, TextRule::kAny,
         "Output folder for trajectory, map and status; an earlier run there is continued. Must be new, "
         "empty or "
         "isobard's own. Empty: no files are written.")
      .basic();
  s.applies(Apply::kLive);
  s.number("cloud_interval_s", &output.cloud_interval_s, "s", 0.2, 3'600.0,
           "Interval between two map clouds for viewers. 2: fast enough to watch, and each cloud holds the "
           "whole local map.");
}

}  // namespace

void add_service_settings(Config& config, std::vector<Setting>& settings) {
  add_input(config.input, settings);
  add_pps(config.pps, settings);
  add_output(config.output, settings);
  SectionBuilder realtime("realtime", UsedBy::kRobot, settings);
  add_scheduling(config.realtime, realtime);
  add_deadlines(config.realtime, realtime);
}

}  // namespace isobar
