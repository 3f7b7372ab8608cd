// SPDX-License-Identifier: BSD-3-Clause
#include "config/setting.hpp"

namespace isobar {
namespace {

void add_priority(const char* key, int& priority, const char* doc, std::vector<Setting>& settings) {
  settings.push_back({key, &priority, "", 1, 99, doc});
}

void add_deadline(const char* key, double& limit_ms, const char* doc, std::vector<Setting>& settings) {
  settings.push_back({key, &limit_ms, "ms", 0.1, 10'000.0, doc});
}

// With the defaults one update of the map in 650 was late beside `stress-ng --cpu 4`, and nothing else
// (tests/benchmark/live).
void add_deadlines(RealtimeSettings& realtime, std::vector<Setting>& settings) {
  add_deadline(
      "realtime.lidar_deadline_ms", realtime.lidar_deadline_ms,
      "From the end of a scan to the scan that is handed on. Whoever is later is counted, and said in "
      "the diagnostics. 10: the packet that tells of the end comes 3 ms after it at most.",
      settings);
  add_deadline("realtime.prior_deadline_ms", realtime.prior_deadline_ms,
               "From an IMU sample to the prior that holds it. 10: two samples at 200 Hz.", settings);
  add_deadline("realtime.registration_deadline_ms", realtime.registration_deadline_ms,
               "From the end of a scan to its pose. 50: half of a scan at 10 Hz is left for what follows.",
               settings);
  add_deadline("realtime.map_deadline_ms", realtime.map_deadline_ms,
               "From a pose to the map that holds its scan. 100: the next scan but one is matched to it.",
               settings);
  settings.push_back(
      {"realtime.prior_reach_ms", &realtime.prior_reach_ms, "ms", 0.0, 100.0,
       "A scan is registered at once when the newest prior is at most so much older than its end. 6: "
       "one sample at 200 Hz, over which a constant twist foretells a turn to 0.1 mrad."});
  settings.push_back(
      {"realtime.prior_wait_ms", &realtime.prior_wait_ms, "ms", 1.0, 1'000.0,
       "Else it waits for the IMU, so long after it came at most; then it goes on without. 50: it is "
       "registered before the next one comes."});
}

void add_realtime(RealtimeSettings& realtime, std::vector<Setting>& settings) {
  settings.push_back({.key = "realtime.enabled",
                      .target = &realtime.enabled,
                      .doc = "Use SCHED_FIFO and keep all memory in RAM. Needs rights; without them isobard "
                             "runs and says so."});
  add_priority("realtime.inertial_priority", realtime.inertial_priority,
               "SCHED_FIFO priority; IMU samples first.", settings);
  add_priority("realtime.prior_priority", realtime.prior_priority, "SCHED_FIFO priority of the prior.",
               settings);
  add_priority("realtime.lidar_priority", realtime.lidar_priority,
               "SCHED_FIFO priority of the lidar's decoder.", settings);
  add_priority("realtime.registration_priority", realtime.registration_priority,
               "SCHED_FIFO priority of the registration: it takes longest, so it goes last.", settings);
  settings.push_back({"realtime.estimator_cpus", &realtime.estimator_cpus, "", 0, 1'023,
                      "Cores for lidar, inertial, prior and registration; empty: all."});
  settings.push_back(
      {"realtime.map_cpus", &realtime.map_cpus, "", 0, 1'023, "Cores for the map; empty: all."});
  add_deadlines(realtime, settings);
}

void add_name(const char* key, std::string& name, const char* doc, std::vector<Setting>& settings) {
  settings.push_back({.key = key, .target = &name, .doc = doc, .text_rule = TextRule::kName});
}

void add_dds(dds::DdsConfig& dds, std::vector<Setting>& settings) {
  settings.push_back(
      {"dds.domain_id", &dds.domain_id, "", 0, 232, "DDS domain, ROS_DOMAIN_ID of the nodes that listen."});
  settings.push_back({.key = "dds.network_interface",
                      .target = &dds.network_interface,
                      .doc = "Interface to speak on, by name or address; empty: the best one, loopback where "
                             "there is no other.",
                      .text_rule = TextRule::kInterface});
  settings.push_back(
      {"dds.max_message_bytes", &dds.max_message_bytes, "bytes", 1'472, 65'500,
       "Largest datagram. 65500 halves the load of clouds where nobody minds IP fragments, as on loopback."});
  settings.push_back({.key = "dds.ros_namespace",
                      .target = &dds.ros_namespace,
                      .doc = "Put before the topics' names, such as \"robot1\"; empty: none. Never before "
                             "/tf, /tf_static and /diagnostics.",
                      .text_rule = TextRule::kNameOrEmpty});
  add_name("dds.node_name", dds.node_name,
           "Under this name ROS 2 tools show the bridge. A base station that leaves it is isobar_NAME.",
           settings);
  settings.push_back(
      {.key = "dds.ros_gid_bytes",
       .target = &dds.ros_gid_bytes,
       .doc = "Bytes of an endpoint's id in ros_discovery_info: 16 from ROS 2 Iron on, 24 up to Humble.",
       .choices = {"16", "24"}});
  add_name("dds.map_frame", dds.map_frame, "Name of the map's frame.", settings);
  add_name("dds.odom_frame", dds.odom_frame, "Name of the frame of dead reckoning.", settings);
  add_name("dds.base_frame", dds.base_frame, "Name of the robot's frame.", settings);
  add_name("dds.lidar_frame", dds.lidar_frame, "Name of the lidar's frame.", settings);
  add_name("dds.imu_frame", dds.imu_frame, "Name of the IMU's frame.", settings);
  add_name("dds.barometer_frame", dds.barometer_frame, "Name of the barometer's frame.", settings);
  settings.push_back({"dds.odom_rate_hz", &dds.odom_rate_hz, "Hz", 1.0, 1'000.0,
                      "Rate of odom and tf; the IMU's if that is lower. 100 serves controllers."});
  settings.push_back({"dds.altitude_rate_hz", &dds.altitude_rate_hz, "Hz", 0.1, 200.0,
                      "Rate of altitude. Air pressure is filtered to a few hertz anyway."});
  settings.push_back({.key = "dds.publish_clouds",
                      .target = &dds.publish_clouds,
                      .doc = "Publish registered scans and the map. Off saves most of the bridge's load."});
  add_name("dds.base_station", dds.base_station,
           "Name of the base station: its topics are NAME/fluid_pressure and NAME/temperature. A robot "
           "listens to it; a base station bears it, as its frame too.",
           settings);
  settings.push_back({.key = "dds.second_base_station",
                      .target = &dds.second_base_station,
                      .doc = "Name of a second base station, by which a bad first one shows; empty: none.",
                      .text_rule = TextRule::kNameOrEmpty});
  settings.push_back({.key = "dds.receive_base_pressure",
                      .target = &dds.receive_base_pressure,
                      .doc = "Take the pressure of the base stations over DDS."});
  settings.push_back({.key = "dds.receive_sensors",
                      .target = &dds.receive_sensors,
                      .doc = "Take the robot's own sensors from imu/data and wheel/odom. Off: a sensor must "
                             "not reach isobard in two ways."});
}

void add_propagator(PosePropagatorConfig& propagator, std::vector<Setting>& settings) {
  settings.push_back({"dds.propagator.slew_time_s", &propagator.slew_time_s, "s", 0.01, 10.0,
                      "Time constant with which a correction enters odom. Two of them are two scans: one bad "
                      "scan is smoothed."});
  settings.push_back(
      {"dds.propagator.max_slew_m_s", &propagator.max_slew_m_s, "m/s", 1e-3, 100.0,
       "Fastest correction of position. Controllers see it as motion: it stays at walking pace."});
  settings.push_back({"dds.propagator.max_slew_rad_s", &propagator.max_slew_rad_s, "rad/s", 1e-3, 100.0,
                      "Fastest correction of orientation."});
  settings.push_back({"dds.propagator.max_extrapolation_s", &propagator.max_extrapolation_s, "s", 0.0, 5.0,
                      "Without wheels the last velocity is taken on for this long at most."});
}

}  // namespace

void add_service_settings(Config& config, std::vector<Setting>& settings) {
  settings.push_back({.key = "input.address",
                      .target = &config.input.address,
                      .doc = "IPv4 address to listen on; 0.0.0.0 is every interface.",
                      .text_rule = TextRule::kIpv4});
  settings.push_back({"input.port", &config.input.port, "", 1, 65'535, "UDP port of the sample datagrams."});
  settings.push_back({.key = "output.directory",
                      .target = &config.output.directory,
                      .doc = "Folder for trajectory, map and status; empty: nothing is written."});
  settings.push_back({"output.cloud_interval_s", &config.output.cloud_interval_s, "s", 0.2, 3'600.0,
                      "Time between two clouds of the map for viewers."});
  add_realtime(config.realtime, settings);
  add_dds(config.dds, settings);
  add_propagator(config.dds.propagator, settings);
}

void add_map_file_settings(MapFileSettings& files, std::vector<Setting>& settings) {
  settings.push_back({.key = "map.directory",
                      .target = &files.directory,
                      .doc =
                          "Folder in which isobard keeps the map that is too far for memory; a map that is "
                          "there is replaced. Empty: the folder map in output.directory; without that one "
                          "what is far is forgotten."});
  settings.push_back({"map.max_disk_gb", &files.max_disk_gb, "GB", 0.001, 1'000.0,
                      "Disk that the map may take; then the part that left memory longest ago goes. Ten "
                      "million points take about half of one."});
}

}  // namespace isobar
