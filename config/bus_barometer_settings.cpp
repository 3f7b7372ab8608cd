// SPDX-License-Identifier: BSD-3-Clause
#include "config/bus_barometer_settings.hpp"

#include <string>

#include "config/section_builder.hpp"

namespace isobar {
namespace {

constexpr const char* kBusDoc =
    "Device of the kernel's bus: \"/dev/i2c-1\", or \"/dev/spidev0.0\" for a sensor on SPI, where address "
    "has no "
    "meaning. isobard needs the right to open it.";

std::vector<std::string> powers(int lowest, int highest) {
  std::vector<std::string> words;
  for (int power = lowest; power <= highest; power *= 2) words.push_back(std::to_string(power));
  return words;
}

/// Not basic, unlike those of the DPS310: four more sensors would fill the basic settings.
void add_place(SectionBuilder& section, std::string& bus, std::string& address,
               const std::vector<std::string>& addresses, const char* address_doc) {
  section.text("bus", bus, TextRule::kAny, kBusDoc);
  section.choice("address", &address, addresses, address_doc);
}

void add_filter(SectionBuilder& section, int& coefficient) {
  section.choice(
      "iir_coefficient", &coefficient, {"0", "1", "3", "7", "15", "31", "63", "127"},
      "Coefficient c of the sensor's own low-pass filter: a new value counts 1/(c+1). 0: off, since "
      "isobard filters the pressure itself and knows the delay of its own filter.");
}

void add_dps310(dps310::Settings& dps310, std::vector<Setting>& settings) {
  const std::vector<std::string> powers_of_two = powers(1, 128);
  SectionBuilder s("barometer.dps310", UsedBy::kEveryRole, settings);
  s.text("bus", dps310.bus, TextRule::kAny, kBusDoc).basic();
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
  s.text("ready_chip", dps310.ready_chip, TextRule::kAny,
         "GPIO chip of the data-ready line. isobard needs the right to open it.");
  s.number(
      "ready_line", &dps310.ready_line, "", -1, 511,
      "Line of the GPIO chip that is tied to the sensor's pin SDO, its interrupt on I2C. The sensor is then "
      "read once a measurement, and the kernel's stamp of the edge is the time of its end. -1: no line, the "
      "sensor is polled.");
}

void add_bmp581(bmp581::Settings& bmp581, std::vector<Setting>& settings) {
  SectionBuilder s("barometer.bmp581", UsedBy::kEveryRole, settings);
  add_place(s, bmp581.bus, bmp581.address, {"0x47", "0x46"},
            "I2C address of the sensor. 0x47, or 0x46 where its pin SDO is tied to ground.");
  std::vector<std::string> rates;
  rates.reserve(bmp581::kRates.size());
  for (const bmp581::Rate& rate : bmp581::kRates) rates.push_back(std::to_string(rate.hz));
  s.choice(
      "rate_hz", &bmp581.rate_hz, rates,
      "Measurements per second [Hz]. The rate times the measurement time must be below 1 s; a pressure takes "
      "1, 1.7, 2.9, 5.4, 10.4, 20.4, 40.4 or 80.4 ms by oversampling, a temperature at least 1 ms. 50 is the "
      "largest round one that 16 readings allow.");
  s.choice(
      "pressure_oversampling", &bmp581.pressure_oversampling, powers(1, 128),
      "Readings averaged in one pressure; noise 0.78, 0.58, 0.41, 0.3, 0.21, 0.15, 0.11 or 0.08 Pa. More "
      "readings at fewer measurements give the same noise in a second.");
  s.choice(
      "temperature_oversampling", &bmp581.temperature_oversampling, powers(1, 128),
      "Readings averaged in one temperature. 1 suffices up to 16 readings of the pressure, says the data "
      "sheet.");
  add_filter(s, bmp581.iir_coefficient);
}

void add_bmp390(bmp390::Settings& bmp390, std::vector<Setting>& settings) {
  SectionBuilder s("barometer.bmp390", UsedBy::kEveryRole, settings);
  add_place(s, bmp390.bus, bmp390.address, {"0x77", "0x76"},
            "I2C address of the sensor. 0x77, or 0x76 where its pin SDO is tied to ground.");
  s.choice(
      "rate_hz", &bmp390.rate_hz, {"25", "50", "100", "200"},
      "Measurements per second [Hz]. The rate times the measurement time must be below 1 s; it takes 0.8 ms "
      "and 2 ms a reading of pressure or temperature. 50 is the largest that 8 readings allow.");
  s.choice(
      "pressure_oversampling", &bmp390.pressure_oversampling, powers(1, 32),
      "Readings averaged in one pressure; noise 5.1, 3.6, 2.5, 1.8, 1.3 or 0.9 Pa. More readings at fewer "
      "measurements give the same noise in a second.");
  s.choice("temperature_oversampling", &bmp390.temperature_oversampling, powers(1, 32),
           "Readings averaged in one temperature. 1 suffices up to 8 readings of the pressure, says the data "
           "sheet.");
  add_filter(s, bmp390.iir_coefficient);
}

void add_icp20100(icp20100::Settings& icp20100, std::vector<Setting>& settings) {
  SectionBuilder s("barometer.icp20100", UsedBy::kEveryRole, settings);
  add_place(s, icp20100.bus, icp20100.address, {"0x63", "0x64"},
            "I2C address of the sensor. 0x63, or 0x64 where its pin ADDR is tied to the supply.");
  s.choice(
      "rate_hz", &icp20100.rate_hz, {"120", "40", "25"},
      "Measurements per second [Hz]. The sensor's filter is always on; its bandwidth is a quarter of the "
      "rate and its delay 7 measurements. 120: the shortest delay, 58 ms.");
}

void add_ms5611(ms5611::Settings& ms5611, std::vector<Setting>& settings) {
  SectionBuilder s("barometer.ms5611", UsedBy::kEveryRole, settings);
  add_place(s, ms5611.bus, ms5611.address, {"0x77", "0x76"},
            "I2C address of the sensor. 0x77, or 0x76 where its pin CSB is tied to the supply.");
  s.number("rate_hz", &ms5611.rate_hz, "Hz", 1, 200,
           "Measurements per second. The rate times the conversion times of pressure and temperature must be "
           "below "
           "1 s; one takes 0.6, 1.2, 2.3, 4.6 or 9.1 ms by oversampling.");
  s.choice("pressure_oversampling", &ms5611.pressure_oversampling, {"4096", "2048", "1024", "512", "256"},
           "Readings averaged in one pressure; noise 6.5, 4.2, 2.7, 1.8 or 1.2 Pa. 4096: the least noise.");
  s.choice(
      "temperature_oversampling", &ms5611.temperature_oversampling, powers(256, 4096),
      "Readings averaged in one temperature. 1024 resolve 0.005 degrees, which are less than the pressure's "
      "noise.");
}

}  // namespace

void add_bus_barometers(BarometerSettings& barometer, std::vector<Setting>& settings) {
  add_dps310(barometer.dps310, settings);
  add_bmp581(barometer.bmp581, settings);
  add_bmp390(barometer.bmp390, settings);
  add_icp20100(barometer.icp20100, settings);
  add_ms5611(barometer.ms5611, settings);
}

}  // namespace isobar
