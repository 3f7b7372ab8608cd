// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imu_source.hpp"

#include "drivers/iio/imu_buffer.hpp"
#include "drivers/vn100/sensor.hpp"
#include "drivers/xsens/sensor.hpp"

namespace isobar {
namespace {

std::unique_ptr<Device<InertialReading>> make_imu(const ImuSettings& imu) {
  switch (imu.source) {
    case ImuSource::kDatagram:
    case ImuSource::kDds:
    case ImuSource::kNone:
    case ImuSource::kLidar:  // the LidarThread's
      return nullptr;
    case ImuSource::kVn100:
      return vn100::make_sensor(imu.vn100);
    case ImuSource::kXsens:
      return xsens::make_sensor(imu.xsens);
    case ImuSource::kIio:
      return std::make_unique<iio::ImuBuffer>(imu.iio);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<ImuThread> make_imu_thread(const Config& config, const ThreadSettings& scheduling) {
  std::unique_ptr<Device<InertialReading>> device = make_imu(config.imu);
  const bool with_pressure = config.barometer.source == BarometerSource::kImu;
  return device ? std::make_unique<ImuThread>(std::move(device), with_pressure, scheduling) : nullptr;
}

std::int64_t imu_period_ns(const ImuSettings& imu) {
  const int rate_hz = imu.source == ImuSource::kVn100   ? imu.vn100.rate_hz
                      : imu.source == ImuSource::kXsens ? imu.xsens.rate_hz
                                                        : imu.iio.rate_hz;
  return 1'000'000'000 / rate_hz;
}

}  // namespace isobar
