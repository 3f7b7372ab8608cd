// SPDX-License-Identifier: BSD-3-Clause
// Every barometer on a bus, with its model, for tests of what they all promise.
#pragma once

#include "drivers/bmp390/sensor.hpp"
#include "drivers/bmp581/sensor.hpp"
#include "drivers/icp20100/sensor.hpp"
#include "drivers/ms5611/sensor.hpp"
#include "tests/drivers/barometer/bench.hpp"
#include "tests/drivers/bmp390/chip_model.hpp"
#include "tests/drivers/bmp581/chip_model.hpp"
#include "tests/drivers/icp20100/chip_model.hpp"
#include "tests/drivers/ms5611/chip_model.hpp"

namespace isobar::test {

struct Bmp581 {
  using Sensor = bmp581::Sensor;
  using Settings = bmp581::Settings;
  using Bench = BarometerBench<bmp581::ChipModel, Sensor, Settings>;
  static constexpr const char* kPlace = "BMP581 on /dev/i2c-1 at 0x47";
  static constexpr double kNoisePa = 0.21;
  static constexpr double kVariancePa2 = 0.21 * 0.21;
  static constexpr double kBitPa = 1.0 / 64.0;
  static constexpr bool kIdentified = true;  ///< by a register, without a write
  static constexpr bool kNeedsBursts = false;
};

struct Bmp390 {
  using Sensor = bmp390::Sensor;
  using Settings = bmp390::Settings;
  using Bench = BarometerBench<bmp390::ChipModel, Sensor, Settings>;
  static constexpr const char* kPlace = "BMP390 on /dev/i2c-1 at 0x77";
  static constexpr double kNoisePa = 1.8;
  static constexpr double kVariancePa2 = 1.8 * 1.8;
  static constexpr double kBitPa = 0.02;
  static constexpr bool kIdentified = true;
  static constexpr bool kNeedsBursts = false;
};

struct Icp20100 {
  using Sensor = icp20100::Sensor;
  using Settings = icp20100::Settings;
  using Bench = BarometerBench<icp20100::ChipModel, Sensor, Settings>;
  static constexpr const char* kPlace = "ICP-20100 on /dev/i2c-1 at 0x63";
  static constexpr double kNoisePa = 1.0;
  static constexpr double kVariancePa2 = 2.0;  ///< four results a bandwidth: twice the square
  static constexpr double kBitPa = 40e3 / 131'072;
  static constexpr bool kIdentified = true;
  static constexpr bool kNeedsBursts = true;
};

struct Ms5611 {
  using Sensor = ms5611::Sensor;
  using Settings = ms5611::Settings;
  using Bench = BarometerBench<ms5611::ChipModel, Sensor, Settings>;
  static constexpr const char* kPlace = "MS5611 on /dev/i2c-1 at 0x77";
  static constexpr double kNoisePa = 1.2;
  static constexpr double kVariancePa2 = 1.2 * 1.2;
  static constexpr double kBitPa = 0.03;
  static constexpr bool kIdentified = false;
  static constexpr bool kNeedsBursts = true;
};

}  // namespace isobar::test
