// SPDX-License-Identifier: BSD-3-Clause
#include "run/mcap/message_definitions.hpp"

#include <algorithm>
#include <array>

#include "core/errors.hpp"
#include "core/text_list.hpp"

namespace isobar::mcap {

namespace {

struct Definition {
  std::string_view type;
  std::string_view members;  ///< one a line; types of other packages with the package's name
};

constexpr std::array kDefinitions{
    Definition{"builtin_interfaces/msg/Time", "int32 sec\nuint32 nanosec\n"},
    Definition{"std_msgs/msg/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    Definition{"std_msgs/msg/Int32", "int32 data\n"},
    Definition{"std_msgs/msg/Float64", "float64 data\n"},
    Definition{"std_msgs/msg/String", "string data\n"},
    Definition{"geometry_msgs/msg/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/msg/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    Definition{"geometry_msgs/msg/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    Definition{"geometry_msgs/msg/Pose",
               "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    Definition{"geometry_msgs/msg/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    Definition{"geometry_msgs/msg/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/msg/PoseWithCovarianceStamped",
               "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    Definition{"geometry_msgs/msg/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    Definition{"geometry_msgs/msg/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    Definition{"geometry_msgs/msg/TwistWithCovariance",
               "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    Definition{"geometry_msgs/msg/Transform",
               "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    Definition{"geometry_msgs/msg/TransformStamped",
               "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    Definition{"tf2_msgs/msg/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    Definition{"nav_msgs/msg/Odometry",
               "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
               "geometry_msgs/TwistWithCovariance twist\n"},
    Definition{"nav_msgs/msg/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    Definition{"nav_msgs/msg/MapMetaData",
               "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
               "geometry_msgs/Pose origin\n"},
    Definition{"nav_msgs/msg/OccupancyGrid",
               "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    Definition{"sensor_msgs/msg/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    Definition{"sensor_msgs/msg/PointCloud2",
               "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
               "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    Definition{"sensor_msgs/msg/Imu",
               "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
               "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
               "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
               "float64[9] linear_acceleration_covariance\n"},
    Definition{"sensor_msgs/msg/FluidPressure",
               "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n"},
    Definition{"diagnostic_msgs/msg/KeyValue", "string key\nstring value\n"},
    Definition{
        "diagnostic_msgs/msg/DiagnosticStatus",
        "byte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
    Definition{"diagnostic_msgs/msg/DiagnosticArray",
               "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    Definition{
        "isobar_msgs/msg/Altitude",
        "std_msgs/Header header\nfloat64 height\nfloat64 variance\nstring source\nfloat64 bias\n"
        "float64 bias_variance\nfloat64 innovation\nfloat64 airflow\nfloat64 airflow_variance\nbool faulty\n"
        "string drifting\n"},
};

const Definition* find(std::string_view type) {
  const auto* found = std::find_if(kDefinitions.begin(), kDefinitions.end(),
                                   [&](const Definition& one) { return one.type == type; });
  return found == kDefinitions.end() ? nullptr : found;
}

/// "geometry_msgs/Pose" of "geometry_msgs/msg/Pose": the name within a definition.
std::string short_name(std::string_view type) {
  const std::size_t slash = type.find('/');
  return std::string(type.substr(0, slash)) + std::string(type.substr(type.rfind('/')));
}

/// The parts of a type and theirs, each once, in the order of their first use.
void add_parts(const Definition& definition, std::vector<const Definition*>& parts) {
  for (const std::string& line : split_list(definition.members, "\n")) {
    const std::string member = line.substr(0, line.find_first_of(" ["));
    const std::size_t slash = member.find('/');
    if (slash == std::string::npos) continue;
    const Definition* part = find(member.substr(0, slash) + "/msg" + member.substr(slash));
    if (part == nullptr || std::find(parts.begin(), parts.end(), part) != parts.end()) continue;
    parts.push_back(part);
    add_parts(*part, parts);
  }
}

}  // namespace

std::string message_definition(std::string_view type) {
  const Definition* definition = find(type);
  if (definition == nullptr) throw UsageError(std::string(type) + ": no definition of this message");
  std::string text(definition->members);
  std::vector<const Definition*> parts;
  add_parts(*definition, parts);
  for (const Definition* part : parts) {
    text += std::string(80, '=') + "\nMSG: " + short_name(part->type) + "\n" + std::string(part->members);
  }
  return text;
}

std::vector<std::string> message_types() {
  std::vector<std::string> types;
  types.reserve(kDefinitions.size());
  for (const Definition& definition : kDefinitions) types.emplace_back(definition.type);
  return types;
}

}  // namespace isobar::mcap
