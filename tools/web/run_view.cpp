// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "run/evaluation/run_folder.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/run_layout.hpp"
#include "run/files/text_file.hpp"
#include "run/floors/stored_floors.hpp"
#include "run/text/csv_reader.hpp"
#include "tools/web/file_view.hpp"
#include "tools/web/view_json.hpp"

namespace isobar::web {
namespace {

using evaluation::RunFolder;
using evaluation::StatusRow;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kMostPoseRows = 24'000;

/// A counter of counters.csv.
struct Counted {
  std::string name;
  std::int64_t count = 0;
  std::string message;
};

std::vector<Counted> read_counters(const fs::path& file) {
  std::vector<Counted> counters;
  if (!fs::exists(file)) return counters;
  text::CsvReader csv(text::TextLines(file), {"name", "count"}, {"first_message"});
  while (csv.next() == text::CsvReader::Row::kGood) {
    counters.push_back({std::string(csv.field(0)), csv.int64(1), std::string(csv.field(2))});
  }
  return counters;
}

std::vector<PoseRow> pose_rows(const RunFolder& run) {
  std::unordered_map<std::int64_t, const StatusRow*> status;
  for (const StatusRow& row : run.status) status[row.stamp_ns] = &row;
  ThinnedRows<PoseRow> rows(kMostPoseRows);
  for (const evaluation::StampedPose& pose : run.trajectory.poses) {
    PoseRow row;
    row.stamp_ns = pose.stamp_ns;
    row.x_m = pose.position_m.x();
    row.y_m = pose.position_m.y();
    row.z_m = pose.position_m.z();
    row.yaw_deg = evaluation::yaw_rad(pose.attitude) / kRadPerDeg;
    row.registered = true;
    if (const auto found = status.find(pose.stamp_ns); found != status.end()) {
      row.z_sd_m = found->second->sd_z_m;
      row.altimeter_m = found->second->altimeter_height_m;
      row.bias_m = found->second->altimeter_bias_m;
      row.bias_sd_m = found->second->altimeter_bias_sd_m;
      row.registered = found->second->mode == "registered";
    }
    rows.add(row);
  }
  return rows.rows();
}

/// Counters whose names say that something went wrong.
bool is_loss(std::string_view name) {
  constexpr std::array<std::string_view, 14> kWords{
      "lost",   "dropped",  "bad",     "garbage", "truncated", "damaged",   "refused",
      "faults", "too late", "missing", "gaps",    "steps",     "oversized", "implausible"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return name.find(word) != std::string_view::npos; });
}

std::string poses_sentence(const RunFolder& run, double& registered_share) {
  const auto count = [&](const char* mode) {
    return std::count_if(run.status.begin(), run.status.end(),
                         [&](const StatusRow& row) { return row.mode == mode; });
  };
  const auto rows = static_cast<std::ptrdiff_t>(run.status.size());
  const auto began = count("initializing");
  registered_share =
      rows > began ? static_cast<double>(count("registered")) / static_cast<double>(rows - began) : 1.0;
  std::array<char, 160> text{};
  if (rows > 0 && rows == began) {
    std::snprintf(text.data(), text.size(), "%zu poses: too few scans to register one, they begin the map",
                  run.trajectory.poses.size());
  } else {
    std::snprintf(text.data(), text.size(), "%zu poses in %.0f s, %.1f %% of them by lidar%s",
                  run.trajectory.poses.size(), run.trajectory.duration_s(), 100.0 * registered_share,
                  registered_share < 1.0 ? ", the others by motion alone" : "");
  }
  return text.data();
}

Json altimeter_note(const RunFolder& run) {
  const auto faulty = std::count_if(run.status.begin(), run.status.end(),
                                    [](const StatusRow& row) { return row.altimeter_faulty; });
  const auto drifting = std::count_if(run.status.begin(), run.status.end(), [](const StatusRow& row) {
    return !row.altimeter_drifts.empty() && row.altimeter_drifts != "none";
  });
  if (faulty > 0) {
    return note_json(
        "altimeter", "warning",
        "departs from the map by more than air explains in " + std::to_string(faulty) + " poses");
  }
  if (drifting > 0) {
    return note_json("altimeter", "warning", "a barometer drifts in " + std::to_string(drifting) + " poses");
  }
  return note_json("altimeter", "ok", "agrees with the map");
}

Json health_json(const RunFolder& run, const std::vector<Counted>& counters,
                 const std::vector<std::string>& notes) {
  constexpr double kFewRegistered = 0.9;
  double registered_share = 1.0;
  const std::string sentence = poses_sentence(run, registered_share);
  Json health = Json::array();
  health.push_back(note_json("poses", registered_share < kFewRegistered ? "warning" : "ok", sentence));
  const bool has_altimeter = std::any_of(run.status.begin(), run.status.end(), [](const StatusRow& row) {
    return std::isfinite(row.altimeter_height_m);
  });
  if (has_altimeter) health.push_back(altimeter_note(run));
  for (const Counted& counter : counters) {
    if (counter.count == 0 || !is_loss(counter.name)) continue;
    health.push_back(
        note_json(counter.name, "warning",
                  std::to_string(counter.count) + (counter.message.empty() ? "" : ": " + counter.message)));
  }
  for (const std::string& note : notes) health.push_back(note_json("files", "warning", note));
  return health;
}

/// The sensors by the counters "imu: good rows" and "lidar scans".
Json sensors_json(const std::vector<Counted>& counters, double duration_s) {
  constexpr std::string_view kGood = ": good rows";
  Json sensors = Json::array();
  const auto add = [&](const std::string& name, std::int64_t count) {
    sensors.push_back({{"name", name},
                       {"heard", count > 0},
                       {"rate_hz", rounded(static_cast<double>(count) / std::max(duration_s, 0.1), 2)},
                       {"age_s", rounded(duration_s, 1)},
                       {"samples", count},
                       {"lost", nullptr},
                       {"rejected", nullptr},
                       {"dropped", nullptr}});
  };
  std::int64_t scans = 0;
  for (const Counted& counter : counters) {
    if (counter.name == "lidar scans" || counter.name == "lidar: clouds") scans += counter.count;
  }
  add("lidar", scans);
  for (const Counted& counter : counters) {
    if (counter.name.ends_with(kGood)) {
      add(counter.name.substr(0, counter.name.size() - kGood.size()), counter.count);
    }
  }
  return sensors;
}

Json settings_of_run(const fs::path& file, std::vector<std::string>& notes) {
  if (!fs::exists(file)) return Json::array();
  try {
    const std::string text = files::read_text_file(file, std::size_t{1} << 20);
    const std::string name = file.filename().string();
    LoadedConfig loaded = parse_layers({{name, text}});
    return settings_json(loaded.config, &loaded, name);
  } catch (const Error& error) {
    notes.push_back(std::string(error.what()) + "; the settings are left out.");
    return Json::array();
  }
}

/// The map from its tiles, with its floors.
Json read_tiles(const fs::path& folder, MapDraft& draft, std::vector<std::string>& notes) {
  const auto store = FileTileStore::open_to_read(folder);
  const auto read =
      files::for_each_tile(*store, store->header(), std::nullopt, [&](std::span<const MapPoint> points) {
        for (const MapPoint& point : points) {
          draft.add(point.p_map.x(), point.p_map.y(), point.p_map.z(), point.intensity);
        }
      });
  if (read.unreadable > 0) {
    notes.push_back(std::to_string(read.unreadable) +
                    " tiles of the map are unreadable; the first: " + read.first_unreadable);
  }
  const auto path = files::path_of(files::trajectory_of_map(folder));
  return floors_json(files::find_stored_floors(*store, path).floors.floors, files::FloorNames::read(folder));
}

/// The map from map.ply.
void read_ply(const fs::path& file, MapDraft& draft) {
  for (const auto& point : files::read_ply_points(file, MapDraft::kMostPoints).points) {
    draft.add(point[0], point[1], point[2], 0);
  }
}

/// @return the floors
Json read_map(const fs::path& folder, std::uint32_t session, MapTiles& map, std::vector<std::string>& notes) {
  MapDraft draft;
  Json floors = Json::array();
  const fs::path tiles = folder / files::name_of_session(files::kMapDirectory, session);
  const fs::path ply = folder / files::name_of_session(files::kMapPointsFile, session);
  try {
    if (fs::exists(tiles / "map.toml")) {
      floors = read_tiles(tiles, draft, notes);
    } else if (fs::exists(ply)) {
      read_ply(ply, draft);
    }
  } catch (const Error& error) {
    notes.push_back(std::string(error.what()) + "; the map is left out.");
  }
  map.replace(std::move(draft));
  return floors;
}

/// Processing time of each scan, as a curve.
void add_scan_time(const RunFolder& run, std::int64_t origin_ns, Json& signals) {
  ThinnedRows<const StatusRow*> rows(kMostPoseRows);
  for (const StatusRow& row : run.status) {
    if (std::isfinite(row.scan_ms)) rows.add(&row);
  }
  if (rows.rows().empty()) return;
  Json times = Json::array();
  Json values = Json::array();
  for (const StatusRow* row : rows.rows()) {
    times.push_back(seconds_after(row->stamp_ns, origin_ns));
    values.push_back(rounded(row->scan_ms, 3));
  }
  signals.push_back({{"name", "Time per scan"},
                     {"unit", "ms"},
                     {"t_s", std::move(times)},
                     {"series", Json::array({{{"name", "registration"}, {"values", std::move(values)}}})}});
}

/// The files of a run of which only the trajectory is required.
RunFolder read_files(const fs::path& folder, std::uint32_t session) {
  RunFolder run;
  const fs::path trajectory = folder / files::name_of_session(files::kTrajectoryFile, session);
  run.trajectory = evaluation::parse_tum(files::read_text_file(trajectory), trajectory.string());
  const fs::path status = folder / files::name_of_session(files::kStatusFile, session);
  if (fs::exists(status)) {
    run.status = evaluation::parse_status_csv(files::read_text_file(status), status.string());
  }
  if (run.trajectory.repairs.cut_line > 0) run.notes.emplace_back("The last line of the trajectory is cut.");
  return run;
}

}  // namespace

FileView read_run(const fs::path& folder, MapTiles& map) {
  const std::uint32_t session = std::max(1U, files::newest_session(folder));
  const RunFolder run = read_files(folder, session);
  const std::int64_t origin_ns = run.trajectory.poses.front().stamp_ns;
  std::vector<std::string> notes = run.notes;
  if (session > 1) {
    notes.push_back("This is map frame " + std::to_string(session) + ", the newest of the run.");
  }
  Json json = empty_view("run", fs::canonical(folder).filename().string(), origin_ns);
  json["floors"] = read_map(folder, session, map, notes);
  json["map"] = map_json(map.state());
  json["settings"] = settings_of_run(folder / files::kSettingsFile, notes);
  json["poses"] = poses_json(pose_rows(run), origin_ns);
  const fs::path corrected = folder / files::name_of_session(files::kCorrectedTrajectoryFile, session);
  if (fs::exists(corrected)) {
    json["tracks"].push_back(
        track_json("corrected by loops",
                   evaluation::parse_tum(files::read_text_file(corrected), corrected.string()), origin_ns));
  }
  add_scan_time(run, origin_ns, json["signals"]);
  const std::vector<Counted> counters = read_counters(folder / files::kCountersFile);
  for (const Counted& counter : counters) {
    json["counters"].push_back(
        {{"name", counter.name}, {"count", counter.count}, {"message", counter.message}});
  }
  json["sensors"] = sensors_json(counters, run.trajectory.duration_s());
  json["health"] = health_json(run, counters, notes);
  double share = 0.0;
  return {text_of(json),
          poses_sentence(run, share) + ", " + std::to_string(map.state().points) + " points of the map"};
}

}  // namespace isobar::web
