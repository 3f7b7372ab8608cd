// SPDX-License-Identifier: BSD-3-Clause
// After start-up the path from packet to pose allocates nothing. The map thread is not on that path and may.
#include <doctest/doctest.h>

#include <memory>

#include "daemon/lock_step.hpp"
#include "daemon/stage_settings.hpp"
#include "tests/integration/replay/recordings.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::test::test_allocation {

TEST_CASE("the allocation counter works") {
  const std::size_t before = allocation_count();
  const auto number = std::make_unique<int>(3);
  CHECK(*number == 3);
  CHECK(allocation_count() > before);
}

TEST_CASE("after start-up decoder, prior and registration allocate nothing") {
  recording::RecordingReader reader(short_drive());
  const StageSettings settings = stage_settings(with_sensors_of(reader.manifest(), Config{}));
  ScanAssembler decoder(make_lidar_decoder(settings.lidar));
  PriorEstimator prior_estimator(settings.prior);
  Registration registration(settings.registration, settings.method, settings.T_base_lidar);
  LocalMap map(settings.map, settings.T_base_lidar);
  const auto scan = std::make_unique<Scan>();
  const auto registered = std::make_unique<RegisteredScan>();

  std::uint64_t on_the_path = 0;
  std::uint64_t scans = 0;
  recording::Event event;
  while (reader.next(event)) {
    const std::size_t before = allocation_count();
    bool complete = false;
    Prior prior;
    switch (event.kind) {
      case recording::EventKind::kLidarPacket:
        complete = decoder.add_packet(event.packet, event.stamp_ns, *scan).scan_complete;
        break;
      case recording::EventKind::kImu:
        if (prior_estimator.add_imu(event.imu, prior)) registration.add_prior(prior);
        break;
      case recording::EventKind::kPressure:
        prior_estimator.add_pressure(event.pressure);
        break;
      case recording::EventKind::kBasePressure:
        prior_estimator.add_base_pressure(event.pressure);
        break;
      case recording::EventKind::kWheel:
        prior_estimator.add_wheel(event.wheel);
        break;
      case recording::EventKind::kCloud:
        break;
    }
    if (complete) registration.register_scan(*scan, *map.snapshot(), *registered);
    const std::uint64_t spent = allocation_count() - before;
    if (complete) {
      ++scans;
      map.update(*registered);
    }
    if (scans >= 20) on_the_path += spent;
  }
  CHECK(scans > 100);
  CHECK(on_the_path == 0);
}

}  // namespace isobar::test::test_allocation
