// SPDX-License-Identifier: BSD-3-Clause
#include "config/mount_settings.hpp"
#include "config/section_builder.hpp"
#include "core/plausibility.hpp"

namespace isobar {
namespace {

void add_dps310(dps310::Settings& dps310, std::vector<Setting>& settings) {
  const std::vector<std::string> powers_of_two{"1", "2", "4", "8", "16", "32", "64", "128"};
  SectionBuilder s("barometer.dps310", UsedBy::kEveryRole, settings);
  s.text("bus", dps310.bus, TextRule::kAny, "I2C device of the kernel. isobard needs the right to open it.")
      .basic();
  s.choice("address", &dps310.address, {"0x77", "0x76"},
           "I2C address of the sensor. 0x77, or 0x76 where its pin SDO is tied to ground.")
      .basic();
  s.choice("pressure_rate_hz", &dps310.pressure_rate_hz, powers_of_two,
           "Pressure measurements per second [Hz]. The sum of rate times measurement time, of pressure and "
           "temperature, must be below 1 s; a measurement takes 3.6, 5.2, 8.4, 14.8, 27.6, 53.2, 104.4 or "
           "206.8 ms by oversampling.");
  s.choice("pressure_oversampling", &dps310.pressure_oversampling, powers_of_two,
           "Readings averaged in one pressure measurement; noise 2.5, 1, 0.5, 0.4, 0.35, 0.3, 0.2 or 0.2 Pa. "
           "16 is the largest that 32 Hz allow.");
  s.choice("temperature_rate_hz", &dps310.temperature_rate_hz, powers_of_two,
           "Temperature measurements per second [Hz]. 4 suffices: the chip's temperature changes slowly.");
  s.choice("temperature_oversampling", &dps310.temperature_oversampling, powers_of_two,
           "Readings averaged in one temperature measurement. 8 at 4 Hz leave the time that 32 pressures of "
           "16 readings need.");
}

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
       "by UDP. none: this robot has no barometer; its height is the lidar's. Any other word: a sensor of "
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
  add_dps310(barometer.dps310, settings);
  add_setra278(barometer.setra278, settings);
  SectionBuilder iio("barometer.iio", UsedBy::kEveryRole, settings);
  add_iio_device(barometer.iio, iio);
}

}  // namespace

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
