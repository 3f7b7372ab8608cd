// SPDX-License-Identifier: BSD-3-Clause
#include "config/bus_barometer_settings.hpp"
#include "config/mount_settings.hpp"
#include "config/section_builder.hpp"
#include "core/plausibility.hpp"

namespace isobar {
namespace {

void add_iio_device(iio::Settings& device, SectionBuilder& section) {
  section.text("folder", device.folder, TextRule::kAny,
               "Folder of the device in sysfs. The number is the order of discovery; the file `name` in each "
               "folder tells which device it is.");
  section.number("rate_hz", &device.rate_hz, "Hz", 1, 100,
                 "Reading rate. Not above the device's conversion rate: repeated values count as stuck.");
}

void add_setra278(iio::SetraSettings& setra, std::vector<Setting>& settings) {
  SectionBuilder s("barometer.setra278", UsedBy::kEveryRole, settings);
  add_iio_device(setra.device, s);
  s.text("channel", setra.channel, TextRule::kAny,
         "Channel of the converter: the common beginning of its file names in sysfs.");
  setra278::Span& span = setra.span;
  s.number("low_v", &span.low_v, "V", -10.0, 10.0,
           "Voltage at low_pa. With a voltage divider: behind the divider, as the converter sees it.");
  s.number("high_v", &span.high_v, "V", -10.0, 10.0,
           "Voltage at high_pa: 2.5 or 5 by order code. With a voltage divider: behind it.");
  s.number("low_pa", &span.low_pa, "Pa", kPlausiblePressurePa.lowest, kPlausiblePressurePa.highest,
           "Pressure at low_v: 60000, 50000 or 80000 by order code.");
  s.number("high_pa", &span.high_pa, "Pa", kPlausiblePressurePa.lowest, kPlausiblePressurePa.highest,
           "Pressure at high_v: 110000 with every order code.");
}

void add_compensation_file(std::string& file, SectionBuilder& section) {
  section.text("compensation_file", file, TextRule::kAny,
               "Calibration file of this sensor, written by `isobar calibrate`; a relative path starts at "
               "the folder of this configuration. Empty: none.");
}

void add_barometer_section(BarometerSettings& barometer, std::vector<Setting>& settings) {
  SectionBuilder s("barometer", UsedBy::kEveryRole, settings);
  s.choice(
       "source", &barometer.source, kBarometerSourceNames.names(),
       "Source of the barometer's samples; those of any other source are refused. datagram: sample datagrams "
       "by UDP. dds: the ROS 2 topic dds.topics.pressure, through isobar-dds; on robots only. none: this "
       "robot has no barometer; its height is the lidar's. imu: the barometer within the "
       "IMU, which imu.source names. Any other word: a sensor of "
       "this machine, which isobard reads itself, set up in the section of that name.")
      .basic();
  s.used_by(UsedBy::kRobot);
  add_position(s, barometer.mount,
               "Pressure port in base_link. Its lever arm is taken out of the height when the robot "
               "pitches.");
  s.used_by(UsedBy::kEveryRole);
  s.number("stuck_time_s", &barometer.stuck_time_s, "s", 0.0, 600.0,
           "Time without a change of a single bit, and at least 16 readings, after which a sensor of this "
           "machine is stuck: noise changes the last digit of a working one. 0: never, for converters too "
           "coarse to resolve the air's motion.");
  add_compensation_file(barometer.compensation_file, s);
  add_bus_barometers(barometer, settings);
  add_setra278(barometer.setra278, settings);
  SectionBuilder iio("barometer.iio", UsedBy::kEveryRole, settings);
  add_iio_device(barometer.iio, iio);
}

}  // namespace

int BarometerSettings::rate_hz() const noexcept {
  switch (source) {
    case BarometerSource::kDatagram:
    case BarometerSource::kDds:
    case BarometerSource::kNone:
    case BarometerSource::kImu:  // that of the IMU
      return 0;
    case BarometerSource::kDps310:
      return dps310.pressure_rate_hz;
    case BarometerSource::kBmp581:
      return bmp581.rate_hz;
    case BarometerSource::kBmp390:
      return bmp390.rate_hz;
    case BarometerSource::kIcp20100:
      return icp20100.rate_hz;
    case BarometerSource::kMs5611:
      return ms5611.rate_hz;
    case BarometerSource::kSetra278:
      return setra278.device.rate_hz;
    case BarometerSource::kIio:
      return iio.rate_hz;
  }
  return 0;
}

void add_barometer_settings(Config& config, std::vector<Setting>& settings) {
  add_barometer_section(config.barometer, settings);
  add_compensation_settings("barometer.compensation", UsedBy::kEveryRole, config.prior.compensation,
                            settings);
  SectionBuilder base("base_barometer", UsedBy::kRobot, settings);
  add_compensation_file(config.base_barometer.compensation_file, base);
  add_compensation_settings("base_barometer.compensation", UsedBy::kRobot, config.prior.base_compensation,
                            settings);
}

}  // namespace isobar
