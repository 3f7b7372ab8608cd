// SPDX-License-Identifier: BSD-3-Clause
#include "config/mount_settings.hpp"
#include "config/section_builder.hpp"

namespace isobar {
namespace {

constexpr int kSlowestBaud = 9'600;
constexpr int kFastestBaud = 4'000'000;

void add_line(std::string& port, int& baud, SectionBuilder& s) {
  s.text("port", port, TextRule::kAny,
         "Serial port. A name that udev gives, /dev/serial/by-id/NAME, stays the same when the sensor is "
         "plugged "
         "in elsewhere.")
      .basic();
  s.number("baud", &baud, "Bd", kSlowestBaud, kFastestBaud,
           "Baud rate that the sensor has; isobard does not change it. 115200 is the factory setting.");
}

void add_vn100(vn100::Settings& vn100, std::vector<Setting>& settings) {
  SectionBuilder s("imu.vn100", UsedBy::kRobot, settings);
  add_line(vn100.port, vn100.baud, s);
  s.number("rate_hz", &vn100.rate_hz, "Hz", 20, vn100::kSensorRateHz,
           "Measurements per second, a divisor of the sensor's 800. 200 is the most that 115200 Bd carry.");
  s.flag(
      "configure", vn100.configure,
      "Whether isobard sets the sensor's output at every start, which its flash memory does not keep. false: "
      "any binary output with acceleration and angular rate is taken as it comes.");
  s.number("sensor_port", &vn100.sensor_port, "", 1, 2,
           "Serial port of the sensor that is wired: 1 is RS-232, 2 is TTL.");
  s.flag("attitude", vn100.attitude,
         "Whether the attitude of the sensor's own filter is asked for, which recordings then hold. It needs "
         "16 bytes more a measurement.");
}

void add_xsens(xsens::Settings& xsens, std::vector<Setting>& settings) {
  SectionBuilder s("imu.xsens", UsedBy::kRobot, settings);
  add_line(xsens.port, xsens.baud, s);
  s.number("rate_hz", &xsens.rate_hz, "Hz", 20, 400,
           "Measurements per second, a divisor of 400. 100 is the most of the MTi-1 series.");
  s.flag("configure", xsens.configure,
         "Whether isobard sets the sensor's output at the start, which the sensor keeps. false: any MTData2 "
         "with acceleration and "
         "rate "
         "of turn, or their increments, is taken as it comes.");
  s.flag("pressure", xsens.pressure,
         "Whether the pressure is asked for. Models without a barometer are then asked again without it.");
  s.flag("attitude", xsens.attitude,
         "Whether the attitude of the sensor's own filter is asked for, which recordings then hold. It needs "
         "19 bytes more a measurement.");
}

void add_iio(iio::ImuBufferSettings& iio, std::vector<Setting>& settings) {
  SectionBuilder s("imu.iio", UsedBy::kRobot, settings);
  s.text(
      "folder", iio.folder, TextRule::kAny,
      "Folder of the device in sysfs. The number is the order of discovery; the file `name` in each folder "
      "tells which device it is.");
  s.text("device", iio.device, TextRule::kAny,
         "Device file of the buffer. Empty: the one in /dev that is named as the folder.");
  s.text("accel_folder", iio.accel_folder, TextRule::kAny,
         "Folder of the accelerometer, where the chip's driver has it as a device of its own (LSM6DSx, "
         "ICM-42600); "
         "`folder` is then the gyro's. Their samples are paired by the kernel's time stamps. Empty: both are "
         "in one "
         "device.");
  s.text("accel_device", iio.accel_device, TextRule::kAny,
         "Device file of the accelerometer's buffer. Empty: the one in /dev that is named as its folder.");
  s.text("trigger", iio.trigger, TextRule::kAny,
         "Name of the trigger that starts a measurement. Empty: the one that the driver has set.");
  s.number("rate_hz", &iio.rate_hz, "Hz", 20, 1'000,
           "Measurements per second, one of the rates in the file sampling_frequency_available.");
}

}  // namespace

void add_imu_settings(ImuSettings& imu, std::vector<Setting>& settings) {
  SectionBuilder s("imu", UsedBy::kRobot, settings);
  s.choice(
       "source", &imu.source, kImuSourceNames.names(),
       "Source of the IMU's samples; those of any other source are refused. datagram: sample datagrams "
       "by UDP. dds: the ROS 2 topic dds.topics.imu, through isobar-dds. lidar: the IMU within the lidar. "
       "none: this robot has no IMU; "
       "scans are registered as 6-DOF from the wheels or the last motion, and roll, pitch and height "
       "drift with the way. Any other word: a sensor of this machine, which isobard reads itself, set up in "
       "the section of that name.")
      .basic();
  add_position(s, imu.mount, "Origin of the IMU in base_link. 0: at the origin of base_link.");
  add_rotation(s, imu.mount);
  add_vn100(imu.vn100, settings);
  add_xsens(imu.xsens, settings);
  add_iio(imu.iio, settings);
}

}  // namespace isobar
