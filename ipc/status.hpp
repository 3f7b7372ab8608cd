// SPDX-License-Identifier: BSD-3-Clause
// Figures of a running isobard, published with its health: what `isobar status` and `isobar metrics` show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace isobar::ipc {

/// Value of a figure that does not exist (yet).
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Copies a text into a null-terminated field; a longer text is truncated.
inline void copy_text(std::string_view from, char* to, std::size_t capacity) noexcept {
  const std::size_t length = from.size() < capacity - 1 ? from.size() : capacity - 1;
  from.copy(to, length);  // also of a text without data, which memcpy must not get
  std::memset(to + length, 0, capacity - length);
}

/// One sensor's stream.
struct SensorStatus {
  char name[24] = {};          // NOLINT(modernize-avoid-c-arrays): "lidar", null-terminated
  bool heard = false;          ///< at least one sample has arrived
  double rate_hz = kNoValue;   ///< over the last report interval
  double age_s = kNoValue;     ///< since the newest sample was measured
  double offset_s = kNoValue;  ///< the sensor's clock minus the robot clock; none: it has no clock
  /// From the measurement to the arrival, beyond the shortest such time of a sensor with a clock.
  double latency_ms = kNoValue;      ///< median of the last 10 to 20 s
  double latency_p99_ms = kNoValue;  ///< of the same time
  double jitter_ms = kNoValue;  ///< standard deviation of the interval between arrivals, in the same time
  std::uint64_t samples = 0;    ///< used
  std::uint64_t lost = 0;       ///< by the gaps in the sender's numbers or time
  std::uint64_t rejected = 0;   ///< received and refused: format, range, time
  std::uint64_t dropped = 0;    ///< received and dropped for want of time or memory
};

/// Times of one stage: from the moment its input is complete until its output is published.
struct StageStatus {
  char name[16] = {};  // NOLINT(modernize-avoid-c-arrays): "registration", null-terminated
  std::uint64_t outputs = 0;
  std::uint64_t misses = 0;     ///< outputs later than limit_ms
  double median_ms = kNoValue;  ///< of the last minute
  double p99_ms = kNoValue;     ///< of the last minute
  double worst_ms = kNoValue;   ///< since the start
  double limit_ms = kNoValue;   ///< deadline
};

/// The newest pose of base_link in the map frame.
struct PoseFigures {
  char mode[16] = {};    // NOLINT(modernize-avoid-c-arrays): PoseMode, "registered"; empty: no pose yet
  char method[16] = {};  // NOLINT(modernize-avoid-c-arrays): Method that ran, "3dof"
  double age_s = kNoValue;
  double x_m = kNoValue, y_m = kNoValue, z_m = kNoValue;
  double roll_deg = kNoValue, pitch_deg = kNoValue, yaw_deg = kNoValue;
  double xy_sd_m = kNoValue;  ///< larger of the standard deviations of x and y
  double z_sd_m = kNoValue, yaw_sd_deg = kNoValue;
  double overlap = kNoValue;  ///< 0 … 1
};

/// Height of base_link above its start from air pressure.
struct HeightFigures {
  char source[24] =
      {};  // NOLINT(modernize-avoid-c-arrays): HeightSource, "differential"; empty: no prior yet
  double age_s = kNoValue;
  double height_m = kNoValue, sd_m = kNoValue;
  double bias_m = kNoValue, bias_sd_m = kNoValue;  ///< estimated offset of the barometric height
};

struct MapFigures {
  std::uint64_t cells = 0;       ///< in memory
  std::uint64_t tiles = 0;       ///< on disk
  std::uint64_t disk_bytes = 0;  ///< of the tiles
  bool on_disk = false;          ///< tiles are written
  double age_s = kNoValue;       ///< since the last update
};

/// The floor that the robot is on.
struct FloorFigures {
  bool present = false;  ///< floors are told
  bool known = false;    ///< false: the figures are those of the last floor
  std::int32_t number = 0;
  char place[24] = {};          // NOLINT(modernize-avoid-c-arrays): FloorPlace, "between floors"
  double certainty = kNoValue;  ///< 0 … 1
  double z_m = kNoValue;        ///< of the floor, map frame
  char name[48] = {};           // NOLINT(modernize-avoid-c-arrays): null-terminated; may be empty
};

struct ServiceStatus {
  static constexpr std::size_t kMaxSensors = 8;
  static constexpr std::size_t kMaxStages = 8;

  char configuration[16] = {};  // NOLINT(modernize-avoid-c-arrays): hash of the one in force, config_hash()
  char role[16] = {};           // NOLINT(modernize-avoid-c-arrays): "robot" or "base-station"
  double uptime_s = 0.0;
  std::uint32_t sensor_count = 0;
  std::uint32_t stage_count = 0;
  SensorStatus sensors[kMaxSensors];  // NOLINT(modernize-avoid-c-arrays): payload in shared memory
  StageStatus stages[kMaxStages];     // NOLINT(modernize-avoid-c-arrays)
  PoseFigures pose;
  HeightFigures height;
  MapFigures map;
  FloorFigures floor;

  /// Appends a sensor; the last one is overwritten when all places are taken.
  SensorStatus& add_sensor(std::string_view name) noexcept {
    SensorStatus& sensor = sensors[sensor_count < kMaxSensors ? sensor_count++ : kMaxSensors - 1];
    sensor = {};
    copy_text(name, sensor.name, sizeof(sensor.name));
    return sensor;
  }
  /// Appends a stage; the last one is overwritten when all places are taken.
  StageStatus& add_stage(std::string_view name) noexcept {
    StageStatus& stage = stages[stage_count < kMaxStages ? stage_count++ : kMaxStages - 1];
    stage = {};
    copy_text(name, stage.name, sizeof(stage.name));
    return stage;
  }
};

}  // namespace isobar::ipc
