// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/station_health.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "core/stamp.hpp"
#include "daemon/health_entries.hpp"
#include "daemon/health_entry.hpp"
#include "daemon/input_health.hpp"
#include "daemon/timing_health.hpp"

namespace isobar {
namespace {

using ipc::HealthLevel;

void add_barometer(const StationSnapshot& now, const StationSnapshot& before, const Config& config,
                   ipc::HealthReport& report) {
  const StationStatus& station = now.station;
  const auto stuck_ns = static_cast<std::int64_t>(config.prior.altimeter.stuck_timeout_s * 1e9);
  const double elapsed_s = before.now_ns == 0 ? 1.0 : seconds_between(before.now_ns, now.now_ns);
  const double rate_hz = per_second(station.samples, before.station.samples, elapsed_s);
  const std::int64_t unchanged_ns = station.cadence.last_ns() - station.changed_ns;
  if (now.barometer.present) {
    add_device(report, "barometer", barometer_period_ns(config.barometer), now.barometer, before.barometer,
               now.now_ns, rate_hz);
  } else if (unchanged_ns > stuck_ns && !station.cadence.silent(now.now_ns)) {
    add_entry(report, "barometer", HealthLevel::kError,
              fmt::format("stuck: {:.3f} Pa for {:.0f} s", station.newest.pressure_pa,
                          static_cast<double>(unchanged_ns) * 1e-9),
              0.0);
  } else {
    add_stream(report, "barometer", station.cadence.last_ns(), now.now_ns, station.cadence.limit_ns(),
               rate_hz, "UDP port " + std::to_string(config.input.port));
  }
  if (station.samples == 0) return;
  const HealthLevel level = station.cadence.silent(now.now_ns) ? HealthLevel::kStale : HealthLevel::kOk;
  add_entry(report, "barometer/pressure", level, "Pa", station.newest.pressure_pa);
  if (!std::isnan(station.newest.temperature_c)) {
    add_entry(report, "barometer/temperature", level, "degrees C, of the sensor",
              station.newest.temperature_c);
  }
  if (!std::isnan(station.newest.variance_pa2)) {
    add_entry(report, "barometer/noise", level, "Pa, standard deviation of a sample",
              std::sqrt(station.newest.variance_pa2));
  }
}

}  // namespace

void fill_station_health(const StationSnapshot& now, const StationSnapshot& before, const Config& config,
                         ipc::HealthReport& report) {
  constexpr auto kBarometer = static_cast<std::size_t>(datagram::Kind::kPressure);
  add_barometer(now, before, config, report);
  add_timing(report, "barometer", now.station.arrivals.figures(now.now_ns));
  add_count(report, "barometer/lost", now.input.counters.lost[kBarometer],
            before.input.counters.lost[kBarometer], "samples lost, by the gaps in their numbers");
  add_count(report, "station/dropped", now.station.dropped_samples, before.station.dropped_samples,
            "samples dropped: they arrived faster than they were used");
  add_count(report, "station/no_memory", now.station.samples_without_memory,
            before.station.samples_without_memory, "samples dropped: no free chunk of shared memory");
  add_calibration(report, "barometer", now.station.outside_calibration, before.station.outside_calibration,
                  now.station.without_temperature, before.station.without_temperature);
  if (!now.input_waits_for.empty()) {
    add_entry(report, "input", HealthLevel::kError, "waiting: " + now.input_waits_for, 0.0);
  }
  add_input(report, now.input, before.input);
  add_sample_senders(report, now.input, before.input, now.now_ns);
}

}  // namespace isobar
