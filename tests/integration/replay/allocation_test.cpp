// SPDX-License-Identifier: BSD-3-Clause
// After start-up the path from packet to pose allocates nothing. The map thread may: it is not on the path.
#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include "daemon/lock_step.hpp"
#include "daemon/stage_settings.hpp"
#include "tests/integration/replay/recordings.hpp"

namespace {

std::atomic<std::uint64_t> allocations{0};

void* counted(std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}

void* counted_aligned(std::size_t bytes, std::align_val_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (bytes + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes); }
void* operator new[](std::size_t bytes) { return counted(bytes); }
// The ones that do not throw, too: std::stable_sort takes its buffer with them and gives it back to the ones
// below.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted_aligned(bytes, alignment);
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return counted_aligned(bytes, alignment);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

using namespace isobar;        // NOLINT(google-build-using-namespace): a test
using namespace isobar::test;  // NOLINT(google-build-using-namespace)

TEST_CASE("the counter of this test counts") {
  const std::uint64_t before = allocations;
  const auto number = std::make_unique<int>(3);
  CHECK(*number == 3);
  CHECK(allocations > before);
}

TEST_CASE("after start-up no packet, sample or scan makes decoder, prior or registration allocate") {
  recording::RecordingReader reader(short_drive());
  const StageSettings settings = stage_settings(with_sensors_of(reader.manifest(), Config{}));
  velodyne::VelodyneDecoder decoder(settings.lidar);
  PriorEstimator prior_estimator(settings.prior);
  Registration registration(settings.registration, settings.method, settings.T_base_lidar);
  LocalMap map(settings.map, settings.T_base_lidar);
  const auto scan = std::make_unique<Scan>();
  const auto registered = std::make_unique<RegisteredScan>();

  std::uint64_t on_the_path = 0;
  std::uint64_t scans = 0;
  recording::Event event;
  while (reader.next(event)) {
    const std::uint64_t before = allocations;
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
    }
    if (complete) registration.register_scan(*scan, *map.snapshot(), *registered);
    const std::uint64_t spent = allocations - before;
    if (complete) {
      ++scans;
      map.update(*registered);
    }
    if (scans >= 20) on_the_path += spent;
  }
  CHECK(scans > 100);
  CHECK(on_the_path == 0);
}
