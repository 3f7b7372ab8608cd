// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "run/recording/recording_reader.hpp"
#include "tools/web/file_view.hpp"
#include "tools/web/view_json.hpp"

namespace isobar::web {
namespace {

using recording::Event;
using recording::EventKind;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kKinds = 6;
/// Rows of a curve in the page.
constexpr std::size_t kMostSignalRows = 6'000;

/// Up to three values at one time.
struct SignalRow {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> values{};
};
using Signal = ThinnedRows<SignalRow>;

/// Times of one sensor.
struct Stream {
  std::uint64_t samples = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;

  void add(std::int64_t stamp_ns) {
    if (samples++ == 0) first_ns = stamp_ns;
    last_ns = stamp_ns;
  }
  [[nodiscard]] double duration_s() const { return static_cast<double>(last_ns - first_ns) * 1e-9; }
};

/// What is kept of a recording.
struct Content {
  std::array<Stream, kKinds> streams;  ///< by EventKind
  Signal pressure{kMostSignalRows};
  Signal base_pressure{kMostSignalRows};
  Signal gyro{kMostSignalRows};
  Signal accel{kMostSignalRows};
  Signal wheel{kMostSignalRows};

  void add(const Event& event) {
    streams[static_cast<std::size_t>(event.kind)].add(event.stamp_ns);
    switch (event.kind) {
      case EventKind::kLidarPacket:
      case EventKind::kCloud:
        break;
      case EventKind::kImu: {
        const Eigen::Vector3d& gyro_now = event.imu.gyro_rad_s;
        const Eigen::Vector3d& accel_now = event.imu.accel_m_s2;
        gyro.add({event.stamp_ns, {gyro_now.x(), gyro_now.y(), gyro_now.z()}});
        accel.add({event.stamp_ns, {accel_now.x(), accel_now.y(), accel_now.z()}});
        break;
      }
      case EventKind::kPressure:
        pressure.add({event.stamp_ns, {event.pressure.pressure_pa, 0.0, 0.0}});
        break;
      case EventKind::kBasePressure:
        base_pressure.add({event.stamp_ns, {event.pressure.pressure_pa, 0.0, 0.0}});
        break;
      case EventKind::kWheel:
        wheel.add({event.stamp_ns, {event.wheel.vx_m_s, event.wheel.wz_rad_s, 0.0}});
        break;
    }
  }
  /// Stamp of the earliest sample.
  [[nodiscard]] std::int64_t origin_ns() const {
    std::int64_t origin = std::numeric_limits<std::int64_t>::max();
    for (const Stream& stream : streams) {
      if (stream.samples > 0) origin = std::min(origin, stream.first_ns);
    }
    return origin;
  }
};

Json signal_json(const std::string& name, const std::string& unit, const Signal& signal,
                 const std::vector<std::string>& series, std::int64_t origin_ns) {
  Json json{{"name", name}, {"unit", unit}, {"t_s", Json::array()}, {"series", Json::array()}};
  for (const SignalRow& row : signal.rows())
    json["t_s"].push_back(rounded(seconds_after(row.stamp_ns, origin_ns), 4));
  for (std::size_t i = 0; i < series.size(); ++i) {
    Json values = Json::array();
    for (const SignalRow& row : signal.rows()) values.push_back(rounded(row.values[i], 4));
    json["series"].push_back({{"name", series[i]}, {"values", std::move(values)}});
  }
  return json;
}

void add_signals(const Content& content, std::int64_t origin_ns, Json& signals) {
  const auto add = [&](const char* name, const char* unit, const Signal& signal,
                       const std::vector<std::string>& series) {
    if (!signal.rows().empty()) signals.push_back(signal_json(name, unit, signal, series, origin_ns));
  };
  add("Air pressure at the robot", "Pa", content.pressure, {"pressure"});
  add("Air pressure at the base station", "Pa", content.base_pressure, {"pressure"});
  add("Acceleration", "m/s²", content.accel, {"x", "y", "z"});
  add("Angular rate", "rad/s", content.gyro, {"x", "y", "z"});
  add("Wheels: speed", "m/s", content.wheel, {"forward"});
}

Json sensors_json(const Content& content, const recording::Manifest& manifest) {
  const auto file_of = [](const auto& entry) { return entry ? entry->file : std::string(); };
  const bool has_clouds = manifest.lidar && manifest.lidar->holds_clouds();
  const std::array<std::pair<const char*, std::string>, kKinds> kNames{
      {{"lidar_packets", has_clouds ? std::string() : file_of(manifest.lidar)},
       {"imu", file_of(manifest.imu)},
       {"barometer", file_of(manifest.barometer)},
       {"base_barometer", file_of(manifest.base_barometer)},
       {"wheel", file_of(manifest.wheel)},
       {"lidar_clouds", has_clouds ? file_of(manifest.lidar) : std::string()}}};
  Json sensors = Json::array();
  for (std::size_t i = 0; i < kKinds; ++i) {
    const Stream& stream = content.streams[i];
    if (kNames[i].second.empty() && stream.samples == 0) continue;
    const double rate_hz = stream.samples > 1
                               ? static_cast<double>(stream.samples - 1) / std::max(stream.duration_s(), 1e-3)
                               : 0.0;
    sensors.push_back({{"name", kNames[i].first},
                       {"heard", stream.samples > 0},
                       {"rate_hz", rounded(rate_hz, 2)},
                       {"age_s", rounded(stream.duration_s(), 1)},
                       {"samples", stream.samples},
                       {"lost", nullptr},
                       {"rejected", nullptr},
                       {"dropped", nullptr},
                       {"file", kNames[i].second}});
  }
  return sensors;
}

void add_reference(const fs::path& folder, const recording::Manifest& manifest, std::int64_t origin_ns,
                   Json& json) {
  const fs::path file = folder / (manifest.reference ? manifest.reference->file : "reference.tum");
  if (!fs::exists(file)) return;
  try {
    json["tracks"].push_back(track_json(
        "reference", evaluation::parse_tum(files::read_text_file(file), file.string()), origin_ns));
  } catch (const DataError& error) {
    json["health"].push_back(note_json("reference", "warning", error.what()));
  }
}

void add_settings(const fs::path& folder, Json& json) {
  const fs::path file = folder / "settings.toml";
  if (!fs::exists(file)) return;
  try {
    const LoadedConfig loaded =
        parse_layers({{"settings.toml", files::read_text_file(file, std::size_t{1} << 20)}});
    json["settings"] = settings_json(loaded.config, &loaded, "settings.toml");
  } catch (const Error& error) {
    json["health"].push_back(note_json("settings", "warning", error.what()));
  }
}

/// "a recording of 5 sensors, 81 s".
std::string summary_of(const Content& content) {
  std::int64_t last_ns = content.origin_ns();
  std::size_t sensors = 0;
  for (const Stream& stream : content.streams) {
    if (stream.samples == 0) continue;
    ++sensors;
    last_ns = std::max(last_ns, stream.last_ns);
  }
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "a recording of %zu sensors, %.0f s", sensors,
                static_cast<double>(last_ns - content.origin_ns()) * 1e-9);
  return text.data();
}

}  // namespace

FileView read_recording(const fs::path& folder, const ReadProgress& progress) {
  constexpr std::uint64_t kEventsBetween = 2'000;
  recording::RecordingReader reader(folder);
  Content content;
  Event event;
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    content.add(event);
    if (events % kEventsBetween == 0) progress(reader.progress());
  }
  if (content.origin_ns() == std::numeric_limits<std::int64_t>::max()) {
    throw DataError(folder.string() + ": the recording holds no sample");
  }
  const std::int64_t origin_ns = content.origin_ns();
  const recording::Manifest& manifest = reader.manifest();
  Json json = empty_view("recording", fs::canonical(folder).filename().string(), origin_ns);
  json["sensors"] = sensors_json(content, manifest);
  json["health"].push_back(note_json("recording", "ok", summary_of(content)));
  if (!manifest.description.empty()) {
    json["health"].push_back(note_json("description", "ok", manifest.description));
  }
  for (const std::string& warning : reader.warnings()) {
    json["health"].push_back(note_json("recording.toml", "warning", warning));
  }
  for (const recording::Count& count : reader.counts()) {
    json["counters"].push_back(
        {{"name", count.name}, {"count", count.count}, {"message", count.first_message}});
    if (!count.first_message.empty()) {
      json["health"].push_back(note_json(count.name, "warning", count.first_message));
    }
  }
  add_signals(content, origin_ns, json["signals"]);
  add_reference(folder, manifest, origin_ns, json);
  add_settings(folder, json);
  return {text_of(json), summary_of(content)};
}

}  // namespace isobar::web
