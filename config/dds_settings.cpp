// SPDX-License-Identifier: BSD-3-Clause
#include "config/section_builder.hpp"

namespace isobar {
namespace {

void add_network(dds::DdsConfig& dds, SectionBuilder& s) {
  s.number("domain_id", &dds.domain_id, "", -1, 232,
           "DDS domain; must equal ROS_DOMAIN_ID of the ROS 2 nodes that listen. -1: ROS_DOMAIN_ID of "
           "isobar-dds's own environment, else 0, which is theirs; domains beyond 232 have no UDP ports.")
      .basic();
  s.text("network_interface", dds.network_interface, TextRule::kInterfaces,
         "Network interfaces of DDS beside loopback, by name or address, separated by commas. They may come "
         "later and change. Empty: all, up to three; \"lo\": this machine only.");
  s.text("peers", dds.peers, TextRule::kIpv4List,
         "Machines that multicast does not reach, which are then found by unicast. Empty: none; within one "
         "network multicast finds all.");
  s.number("max_message_bytes", &dds.max_message_bytes, "bytes", 1'472, 65'500,
           "Largest datagram. 14720 is Cyclone's default; 65500 halves the load of clouds where IP fragments "
           "do no harm, as on loopback.");
}

void add_names(dds::DdsConfig& dds, SectionBuilder& s) {
  s.text("ros_namespace", dds.ros_namespace, TextRule::kRosNameOrEmpty,
         "ROS namespace in front of the topic names, such as \"robot1\"; empty: none. Never in front of /tf, "
         "/tf_static and /diagnostics, which all robots share.");
  s.text("node_name", dds.node_name, TextRule::kRosNode,
         "Node name of isobar-dds in ROS 2 tools. A base station with the default is named isobar_STATION.");
  s.choice("ros_gid_bytes", &dds.ros_gid_bytes, {"16", "24"},
           "Bytes of an endpoint's id in ros_discovery_info: 16 from ROS 2 Iron on, 24 up to Humble.");
}

void add_topics(dds::TopicNames& names, std::vector<Setting>& settings) {
  SectionBuilder s("dds.topics", UsedBy::kEveryRole, settings);
  s.applies(Apply::kLive);
  const auto name = [&s](const char* key, std::string& target, const char* doc) {
    s.text(key, target, TextRule::kRosName, doc);
  };
  name("diagnostics", names.diagnostics,
       "Name of diagnostics, without ros_namespace as all robots share it.");
  name("base_pressure", names.base_pressure, "Name of a base station's pressure, below the station's name.");
  name("base_temperature", names.base_temperature, "Name of its temperature, below the station's name.");
  s.used_by(UsedBy::kRobot);
  name("odom", names.odom, "Name of the odometry, below ros_namespace like all that follow but tf.");
  name("pose", names.pose, "Name of the registered pose, one a scan.");
  name("altitude", names.altitude, "Name of the height from air pressure.");
  name("tf", names.tf,
       "Name of the transforms, without ros_namespace; \"robot1/tf\" is one robot's own tree.");
  name("tf_static", names.tf_static, "Name of the fixed transforms, without ros_namespace.");
  name("registered_scan", names.registered_scan, "Name of the registered scan, a cloud in base_link.");
  name("map_cloud", names.map_cloud, "Name of the map's points. Not \"map\", where Nav2 expects a grid.");
  name("map", names.map, "Name of the occupancy grid of the robot's floor. \"map\": where Nav2 expects it.");
  name("floor", names.floor, "Name of the number of the robot's floor.");
  name("floor_name", names.floor_name, "Name of the name of the robot's floor.");
  name("points", names.points, "Name of the lidar's clouds, received where lidar.source is \"dds\".");
  name("pressure", names.pressure,
       "Name of the robot's own air pressure, received where barometer.source is \"dds\".");
  name("imu", names.imu, "Name of the IMU's samples, received where imu.source is \"dds\".");
  name("wheel", names.wheel, "Name of the wheels' odometry, received where wheel.source is \"dds\".");
  name("initial_pose", names.initial_pose,
       "Name of the hints of where the robot is. \"initialpose\": where RViz and Nav2 send them.");
}

void add_input_qos(dds::InputsQos& inputs, std::vector<Setting>& settings) {
  SectionBuilder s("dds.qos", UsedBy::kRobot, settings);
  s.applies(Apply::kLive);
  const auto input = [&s](const std::string& name, dds::InputQos& qos, const char* reliability_doc,
                          const char* depth_doc) {
    s.choice((name + "_reliability").c_str(), &qos.reliability, dds::kReliabilityNames.names(),
             reliability_doc);
    s.number((name + "_depth").c_str(), &qos.depth, "messages", 1, 1'000, depth_doc);
  };
  input(
      "points", inputs.points,
      "Reliability asked of the writer of dds.topics.points. best_effort: fits every writer. reliable: lost "
      "messages are sent again, but a best-effort writer, as of most lidar drivers, does not match: no data.",
      "Clouds that wait for isobar-dds; a newer one drops the oldest. 5: half a second at 10 Hz.");
  input("pressure", inputs.pressure,
        "As points_reliability, of dds.topics.pressure. best_effort: a lost sample does not matter.",
        "As points_depth. 5: a barometer sends at most some ten samples a second.");
  input("imu", inputs.imu,
        "As points_reliability, of dds.topics.imu. best_effort: a sample that is sent again comes too late.",
        "As points_depth. 50: an eighth of a second at 400 Hz, longer than the conversion of a cloud.");
  input("wheel", inputs.wheel,
        "As points_reliability, of dds.topics.wheel. best_effort: the next sample tells the way as well.",
        "As points_depth. 10: a fifth of a second at 50 Hz.");
  input("initial_pose", inputs.initial_pose,
        "As points_reliability, of dds.topics.initial_pose. reliable: a hint is sent once, and RViz, "
        "Foxglove and "
        "Nav2 offer it.",
        "As points_depth. 5: a person sends them.");
  input("base_pressure", inputs.base_pressure,
        "As points_reliability, of dds.topics.base_pressure and base_temperature. best_effort: isobar's own "
        "base "
        "stations offer no more.",
        "As points_depth. 5: a base station sends at most some ten samples a second.");
}

void add_frames(dds::DdsConfig& dds, SectionBuilder& s) {
  s.text("frame_prefix", dds.frame_prefix, TextRule::kPrefix,
         "In front of every frame name, such as \"robot1/\", so that several robots share one /tf. Empty: "
         "none.");
  s.text("map_frame", dds.map_frame, TextRule::kName, "Frame of the map, named as in REP-105.");
  s.text("odom_frame", dds.odom_frame, TextRule::kName,
         "Frame in which the pose has no jumps, named as in REP-105.");
  s.text("base_frame", dds.base_frame, TextRule::kName, "Frame of the robot, named as in REP-105.");
  s.text("footprint_frame", dds.footprint_frame, TextRule::kNameOrEmpty,
         "Frame on the ground under base_frame, with its yaw only, such as \"base_footprint\". /tf then has "
         "odom to "
         "it and it to base_frame. Empty: none, odom to base_frame.");
  s.number(
      "footprint_depth_m", &dds.footprint_depth_m, "m", 0.0, 10.0,
      "Height of base_frame above the ground where that is level, for footprint_frame. 0: base_frame is on "
      "the ground.");
  s.text("lidar_frame", dds.lidar_frame, TextRule::kName,
         "Frame of the lidar in /tf_static. Must be unique among the robot's frames.");
  s.text("imu_frame", dds.imu_frame, TextRule::kName,
         "Frame of the IMU in /tf_static. Must be unique among the robot's frames.");
  s.text("barometer_frame", dds.barometer_frame, TextRule::kName,
         "Frame of the barometer in /tf_static. Must be unique among the robot's frames.");
}

void add_outputs(dds::DdsConfig& dds, SectionBuilder& s) {
  s.number("odom_rate_hz", &dds.odom_rate_hz, "Hz", 1.0, 1'000.0,
           "Publishing rate of odom and tf; the IMU's rate if that is lower. 100 suffices for controllers.");
  s.number("altitude_rate_hz", &dds.altitude_rate_hz, "Hz", 0.1, 200.0,
           "Publishing rate of altitude. 10: air pressure is filtered to a few hertz anyway.");
  s.flag("publish_clouds", dds.publish_clouds,
         "Publish the registered scans and the map as clouds. false saves most of the load of isobar-dds.");
  s.flag("publish_tf_map_odom", dds.publish_tf_map_odom,
         "Publish map to odom in /tf. false where another localisation owns it.");
  s.flag("publish_tf_odom_base", dds.publish_tf_odom_base,
         "Publish odom to base_link in /tf. false where another odometry or a filter owns it.");
  s.flag("publish_tf_static", dds.publish_tf_static,
         "Publish the mounts of the sensors in /tf_static. false where a robot description does.");
}

void add_inputs(dds::DdsConfig& dds, SectionBuilder& s) {
  s.text("second_base_station", dds.second_base_station, TextRule::kNameOrEmpty,
         "Name of a second base station, against which a faulty first one is noticed. Empty: none.");
  s.choice("wheel_type", &dds.wheel_type, {"odometry", "twist"},
           "Message type of the topic dds.topics.wheel: nav_msgs/Odometry, or "
           "geometry_msgs/TwistWithCovarianceStamped.");
  s.flag("imu_orientation", dds.imu_orientation,
         "Use the orientation in the messages of dds.topics.imu, where they hold one. false: for an IMU "
         "whose own "
         "filter is not to be trusted.");
  s.flag(
      "receive_initial_pose", dds.receive_initial_pose,
      "Take hints of where the robot is from dds.topics.initial_pose. They are believed only where the scans "
      "match.");
  s.flag("receive_base_pressure", dds.receive_base_pressure,
         "Receive the base stations' pressure over DDS. true: base stations publish it there.");
}

void add_propagator(PosePropagatorConfig& propagator, std::vector<Setting>& settings) {
  SectionBuilder s("dds.propagator", UsedBy::kRobot, settings);
  s.applies(Apply::kLive);
  s.number("slew_time_s", &propagator.slew_time_s, "s", 0.01, 10.0,
           "Time constant with which a correction enters odom. 0.1: within two scans odom follows the "
           "registered pose, and one bad scan is smoothed.");
  s.number("max_slew_m_s", &propagator.max_slew_m_s, "m/s", 1e-3, 100.0,
           "Fastest correction of the position in odom. Controllers see a correction as motion; 1 is walking "
           "pace.");
  s.number("max_slew_rad_s", &propagator.max_slew_rad_s, "rad/s", 1e-3, 100.0,
           "Fastest correction of the orientation in odom. Controllers see a correction as motion; 1 is 57 "
           "deg/s.");
  s.number("max_extrapolation_s", &propagator.max_extrapolation_s, "s", 0.0, 5.0,
           "Longest extrapolation of the last velocity between scans without wheels. 0.5: five scans at 10 "
           "Hz.");
}

}  // namespace

void add_dds_settings(dds::DdsConfig& dds, std::vector<Setting>& settings) {
  SectionBuilder s("dds", UsedBy::kEveryRole, settings);
  s.applies(Apply::kLive);  // isobar-dds follows isobard's configuration
  add_network(dds, s);
  add_names(dds, s);
  s.text("base_station", dds.base_station, TextRule::kName,
         "Name of the base station, whose topics are NAME/fluid_pressure and NAME/temperature. A robot "
         "listens to it; a base station bears it, also as its frame.")
      .basic();
  s.text(
      "keys_directory", dds.keys_directory, TextRule::kAny,
      "Folder with the keys of this machine, made by `isobar keys`; customary is /etc/isobar/keys. A base "
      "station signs its pressure with them, a robot then accepts none that is not signed. Empty: unsigned.");
  s.used_by(UsedBy::kRobot);
  add_frames(dds, s);
  add_outputs(dds, s);
  add_inputs(dds, s);
  add_topics(dds.topics, settings);
  add_input_qos(dds.input_qos, settings);
  add_propagator(dds.propagator, settings);
}

}  // namespace isobar
