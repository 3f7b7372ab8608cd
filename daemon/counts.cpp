// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/counts.hpp"

#include <array>
#include <iterator>

namespace isobar {

std::vector<files::RunCount> counts_of(const LidarCounters& counters,
                                       const std::string& wrong_model_message) {
  return {
      {"lidar packets", counters.packets, ""},
      {"lidar packets truncated", counters.truncated, ""},
      {"lidar packets oversized", counters.oversized, ""},
      {"lidar packets garbage", counters.garbage, ""},
      {"lidar packets of another model", counters.wrong_model,
       counters.wrong_model > 0 ? wrong_model_message : std::string{}},
      {"lidar packets duplicated", counters.duplicated, ""},
      {"lidar packets reordered", counters.reordered, ""},
      {"lidar packets too late", counters.too_late, ""},
      {"lidar packets lost", counters.lost, ""},
      {"lidar packets without points", counters.no_points, ""},
      {"lidar clock steps", counters.clock_steps, ""},
      {"lidar returns", counters.returns, ""},
      {"lidar scans", counters.scans, ""},
  };
}

std::vector<files::RunCount> counts_of(const BuildingCounts& counts) {
  return {
      {"loop key scans", counts.key_scans, ""},
      {"loop submaps", counts.submaps, ""},
      {"loop places tried", counts.tried, ""},
      {"loop places matched", counts.matched, ""},
      {"loops confirmed by a second one", counts.accepted, ""},
      {"loops that correct the trajectory", counts.taken, ""},
  };
}

std::vector<files::RunCount> counts_of(const PriorCounters& counters) {
  return {
      {"imu samples", counters.imu_accepted, ""},
      {"imu samples with bad values", counters.imu_bad_value, ""},
      {"imu samples with bad times", counters.imu_bad_time, ""},
      {"imu starts without gravity", counters.imu_wrong_gravity,
       counters.imu_wrong_gravity > 0 ? "the mean specific force is not 9.8 m/s^2: is it in g?" : ""},
      {"imu gaps", counters.imu_gaps, ""},
      {"imu restarts", counters.imu_restarts, ""},
      {"barometer samples", counters.pressure_accepted, ""},
      {"barometer samples outside of the calibrated range", counters.pressure_outside_calibration, ""},
      {"barometer samples without the temperature that the calibration needs",
       counters.pressure_without_temperature, ""},
      {"barometer samples with bad values", counters.pressure_bad_value, ""},
      {"barometer samples with bad times", counters.pressure_bad_time, ""},
      {"barometer samples repeated", counters.pressure_repeated, ""},
      {"barometer samples gated", counters.pressure_gated, ""},
      {"barometer steps believed", counters.pressure_steps, ""},
      {"base samples", counters.base_accepted, ""},
      {"base samples outside of the calibrated range", counters.base_outside_calibration, ""},
      {"base samples without the temperature that the calibration needs", counters.base_without_temperature,
       ""},
      {"base samples with bad values", counters.base_bad_value, ""},
      {"base samples with bad times", counters.base_bad_time, ""},
      {"base samples repeated", counters.base_repeated, ""},
      {"base samples too old", counters.base_stale, ""},
      {"base station lost", counters.base_lost, ""},
      {"base station switched", counters.base_switched, ""},
      {"barometer faults", counters.robot_faults, ""},
      {"base station faults", counters.base_faults, ""},
      {"thermometer faults", counters.thermometer_faults, ""},
      {"wheel samples", counters.wheel_accepted, ""},
      {"wheel samples with bad values", counters.wheel_bad_value, ""},
      {"wheel samples with bad times", counters.wheel_bad_time, ""},
      {"wheel samples whose variance is not believed", counters.wheel_bad_variance, ""},
      {"wheel seconds of slip in a turn", counters.wheel_turn_slips, ""},
      {"wheel seconds of slip in speed", counters.wheel_speed_slips, ""},
      {"moving ground", counters.moving_ground, ""},
  };
}

std::vector<files::RunCount> counts_of(const datagram::Counters& counters) {
  constexpr std::array<const char*, datagram::kKinds> kNames = {"imu", "baro", "base", "wheel"};
  std::vector<files::RunCount> counts = {
      {"sample datagrams", counters.datagrams, ""},
      {"sample lines malformed", counters.malformed, ""},
      {"sample lines implausible", counters.implausible, ""},
      {"sample lines of unknown kind", counters.unknown_kind, ""},
  };
  for (std::size_t kind = 0; kind < datagram::kKinds; ++kind) {
    const std::string name = std::string(kNames[kind]) + " lines ";
    counts.push_back({name + "good", counters.samples[kind], ""});
    counts.push_back({name + "lost", counters.lost[kind], ""});
    counts.push_back({name + "duplicated", counters.duplicated[kind], ""});
    counts.push_back({name + "reordered", counters.reordered[kind], ""});
  }
  return counts;
}

std::vector<files::RunCount> counts_of(const BaseStationStatus& base) {
  using V = BaseVerdict;
  return {
      {"base lines in time", base.count(V::kAccepted), ""},
      {"base lines that came before", base.count(V::kRepeated), ""},
      {"base lines outdated", base.count(V::kOutdated), ""},
      {"base lines too old", base.count(V::kTooOld), ""},
      {"base lines from the future", base.count(V::kAhead), ""},
      {"base lines of another station", base.count(V::kOtherSender), ""},
      {"base lines of a new sender", base.count(V::kUnconfirmed), ""},
      {"base station outages", base.outages, ""},
      {"base station restarts", base.restarts, ""},
      {"base station returns", base.returns, ""},
      {"base station clock steps", base.clock_steps, ""},
  };
}

std::vector<files::RunCount> counts_of(const DeviceCounters& counters) {
  return {
      {"barometer readings", counters.samples, ""},
      {"barometer accesses failed", counters.io_errors, ""},
      {"barometer starts", counters.starts, ""},
      {"barometer resets of its own", counters.resets, ""},
      {"barometer silences", counters.silent, ""},
      {"barometer stuck", counters.stuck, ""},
      {"barometer readings implausible", counters.implausible, ""},
      {"barometer reads repeated", counters.torn, ""},
  };
}

std::vector<files::RunCount> counts_of_map(FileTileStore& store, files::RunOutput& output) {
  const std::uint64_t brought_back = store.counters().taken;
  const files::MapExport exported = output.write_map(store, store.header());
  const TileStoreCounters& counters = store.counters();
  return {
      {"map tiles stored", counters.put, ""},
      {"map tiles brought back", brought_back, ""},
      {"map tiles refused by the disk", counters.refused, counters.first_refusal},
      {"map tiles damaged", counters.damaged, counters.first_damage},
      {"map tiles forgotten at the limit", counters.forgotten, ""},
      {"map tiles moved between files", counters.moved, ""},
      {"map tiles missing in map.ply", exported.unreadable, exported.first_unreadable},
  };
}

void run_counts::append(std::vector<files::RunCount>& counts, std::vector<files::RunCount> more) {
  counts.insert(counts.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace isobar
