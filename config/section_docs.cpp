// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "config/setting.hpp"

namespace isobar {

namespace {

struct Doc {
  std::string_view section;
  std::string_view doc;
};

constexpr auto kDocs = std::to_array<Doc>({
    {"lidar", "The lidar, as a live run receives it by UDP. A replay takes it from the recording."},
    {"imu", "The IMU. A replay takes its samples and mount from the recording."},
    {"imu.vn100", "A VectorNav VN-100 on a serial line; used if imu.source is \"vn100\"."},
    {"imu.xsens",
     "An Xsens MTi-1, -3, -10, -100 or -300 series on a serial line; used if imu.source is \"xsens\"."},
    {"imu.iio",
     "An IMU with a kernel driver (industrial I/O), accelerometer and gyro in one device or in two; used if "
     "imu.source "
     "is "
     "\"iio\"."},
    {"barometer", "The robot's barometer. A replay takes its samples and mount from the recording."},
    {"barometer.dps310", "A DPS310 on a bus of this machine; used if barometer.source is \"dps310\"."},
    {"barometer.bmp581", "A BMP581 on a bus of this machine; used if barometer.source is \"bmp581\"."},
    {"barometer.bmp390", "A BMP390 on a bus of this machine; used if barometer.source is \"bmp390\"."},
    {"barometer.icp20100",
     "An ICP-20100 on a bus of this machine; used if barometer.source is \"icp20100\"."},
    {"barometer.ms5611", "An MS5611 on a bus of this machine; used if barometer.source is \"ms5611\"."},
    {"barometer.setra278",
     "A Setra 278 behind an analogue-to-digital converter with a kernel driver (industrial I/O); used if "
     "barometer.source is \"setra278\"."},
    {"barometer.iio",
     "Any other barometer with a kernel driver (industrial I/O); used if barometer.source is \"iio\". "
     "Drivers that round, as the kernel's DPS310 driver does to 1 Pa, need a longer "
     "barometer.stuck_time_s."},
    {"barometer.compensation",
     "Calibration of the robot's barometer, as `isobar calibrate` writes it: p_cal = sum of c_ij u^i v^j, "
     "u = (p - pressure_centre_pa) / pressure_scale_pa, v = (t - temperature_centre_c) / "
     "temperature_scale_c."},
    {"compensation",
     "Calibration of a barometer, written by `isobar calibrate`: p_cal = sum of c_ij u^i v^j, "
     "u = (p - pressure_centre_pa) / pressure_scale_pa, v = (t - temperature_centre_c) / "
     "temperature_scale_c."},
    {"wheel", "The wheels' odometry. A replay takes its samples from the recording."},
    {"wheel.encoder",
     "Quadrature encoders of the wheels on GPIO lines of this machine; used if wheel.source is \"encoder\"."},
    {"base_barometer",
     "The base station's barometer, for a base station that does not compensate its samples itself."},
    {"base_barometer.compensation",
     "Calibration of the first base station's barometer; keys as in barometer.compensation."},
    {"input", "UDP socket on which a live run receives samples of IMU, barometers and wheels."},
    {"pps", "A pulse a second at a GPIO line of this machine, against which the system clock is measured."},
    {"output", "Files and clouds that a live run writes."},
    {"black_box",
     "The last minute of all inputs, kept in memory. Saved as a recording on `isobar blackbox save`, on "
     "SIGUSR1, on a fault, and at the start after a crash."},
    {"realtime", "Scheduling of a live run's threads, and the deadline of each stage."},
    {"dds", "DDS network, topics and frames of isobar-dds."},
    {"dds.topics", "Names of the ROS topics, without leading slash."},
    {"dds.qos", "Quality of service of the readers: what they ask of the nodes that write the inputs."},
    {"dds.propagator", "Smoothing of the registration's corrections in the odom frame."},
    {"altimeter", "Checks of the barometers and conversion of air pressure to height."},
    {"altimeter.air",
     "Air temperature between base station and robot. An error of 10 K is 3.4 % of every height."},
    {"attitude", "Attitude and velocity filter on gyro, accelerometer and wheels."},
    {"standstill", "Detection of a robot that stands still."},
    {"dead_reckoning", "Dead reckoning with wheels."},
    {"height", "Vertical Kalman filter on air pressure, acceleration and wheels."},
    {"limits", "Plausibility limits of the sensor samples. Samples beyond them are refused and counted."},
    {"registration", "Preparation of a scan, matching to the map, solving and acceptance."},
    {"map", "Size and density of the local map, and when it is updated."},
    {"floors", "Floors of the building, and the occupancy grid of the one that the robot is on."},
    {"loops", "Places that are seen again, and the trajectory that is corrected by them."},
});

}  // namespace

std::string_view section_doc(std::string_view section) {
  for (const Doc& entry : kDocs) {
    if (entry.section == section) {
      return entry.doc;
    }
  }
  return {};
}

}  // namespace isobar
