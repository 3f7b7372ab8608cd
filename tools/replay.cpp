// SPDX-License-Identifier: BSD-3-Clause
// `isobar replay`: runs the pipeline over a recording as fast as possible.
#include "daemon/replay.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "config/config_layer.hpp"
#include "core/errors.hpp"
#include "core/names.hpp"
#include "core/nearest_word.hpp"
#include "daemon/stage_settings.hpp"
#include "run/files/run_layout.hpp"
#include "run/import/scratch_folder.hpp"
#include "run/recording/manifest.hpp"
#include "tools/commands.hpp"
#include "tools/import/import_source.hpp"
#include "tools/import/unreadable.hpp"
#include "tools/import_options.hpp"
#include "tools/method_option.hpp"
#include "tools/overridden_settings.hpp"
#include "tools/progress.hpp"
#include "tools/stop_signals.hpp"
#include "tools/subcommand.hpp"

namespace isobar::tools {

namespace {

struct ReplayOptions {
  std::filesystem::path recording;
  std::filesystem::path config;
  std::string method;
  std::filesystem::path out;
  bool replace = false;
  std::string map;
  std::string map_use;
  std::filesystem::path keep;
  ImportRequest import;  ///< of a source that is no recording
};

/// The recording that a foreign source becomes: in the folder of --keep, else in a temporary one that goes with the object.
class ImportedRecording {
 public:
  explicit ImportedRecording(const ReplayOptions& options)
      : source_(options.recording), folder_(options.recording) {
    if (is_recording(source_)) return;
    if (!is_importable(source_)) throw DataError(why_unreadable(source_));
    ImportRequest request = options.import;
    request.source = options.recording;
    request.out = options.keep;
    request.asks_nothing = true;
    if (options.keep.empty()) {
      temporary_.emplace();
      request.out = temporary_->path() / "recording";
      request.link_files = true;
    }
    import_and_print(request);
    folder_ = request.out;
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// A text about a file of the temporary folder, about the source instead: the folder is gone when it is read.
  [[nodiscard]] std::string about_source(std::string text) const {
    if (!temporary_) return text;
    for (const std::string& name : {(folder_ / "lidar.pcap").string(), folder_.string()}) {
      const std::size_t at = text.find(name);
      if (at != std::string::npos) return text.replace(at, name.size(), source_.string());
    }
    return text;
  }

 private:
  std::filesystem::path source_;
  std::filesystem::path folder_;
  std::optional<imports::ScratchFolder> temporary_;
};

/// Counters of normal operation, which are not printed; the others are printed unless zero.
bool is_ordinary(const std::string& name) {
  return name == "lidar packets" || name == "lidar returns" || name == "lidar scans" ||
         name == "imu samples" || name == "barometer samples" || name == "base samples" ||
         name == "wheel samples" || name == "lidar position packets" || name == "map cells seen through" ||
         name == "map tiles stored" || name == "map tiles brought back" ||
         name == "map tiles moved between files" || name == "lidar: packets" || name == "lidar: clouds" ||
         name.ends_with(": good rows") || name.starts_with("loop");
}

/// A run that localises has no map of its own.
void print_written(const std::filesystem::path& out) {
  std::string names;
  for (const char* name :
       {"trajectory.tum", "map.ply", "map/", "status.csv", "counters.csv", "settings.toml"}) {
    std::error_code error;
    if (std::filesystem::exists(out / name, error)) names += std::string(names.empty() ? "" : " ") + name;
  }
  std::printf("written: %s/%s\n", out.c_str(), names.c_str());
}

/// The scans by what became of them.
void print_scans(const ReplaySummary& summary) {
  const std::uint64_t began = summary.poses - summary.registered - summary.from_prior;
  std::printf(
      "%llu scans: %llu poses registered, %llu from the prior, %llu that begin the map; %llu map points\n",
      static_cast<unsigned long long>(summary.scans), static_cast<unsigned long long>(summary.registered),
      static_cast<unsigned long long>(summary.from_prior), static_cast<unsigned long long>(began),
      static_cast<unsigned long long>(summary.map_points));
  std::printf("%.1f s of recording in %.1f s, %.1f times real time\n", summary.recorded_s, summary.wall_s,
              summary.wall_s > 0.0 ? summary.recorded_s / summary.wall_s : 0.0);
}

void print_summary(const ReplaySummary& summary, const ImportedRecording& recording) {
  for (const std::string& warning : summary.warnings) {
    std::printf("note: %s\n", recording.about_source(warning).c_str());
  }
  if (!summary.base_clock.empty()) std::printf("base station clock: %s\n", summary.base_clock.c_str());
  for (const files::RunCount& count : summary.counts) {
    if (count.count == 0 || is_ordinary(count.name) || count.name == "contradiction")
      continue;  // a note already
    const bool is_said = std::find(summary.warnings.begin(), summary.warnings.end(), count.first_message) !=
                         summary.warnings.end();
    std::printf("counted: %s: %llu%s%s\n", count.name.c_str(), static_cast<unsigned long long>(count.count),
                count.first_message.empty() || is_said ? "" : "; first: ",
                is_said ? "" : recording.about_source(count.first_message).c_str());
  }
  print_scans(summary);
  if (summary.loops > 0) {
    std::printf(
        "%llu loops, places that the robot saw again: trajectory-corrected.tum is corrected by them\n",
        static_cast<unsigned long long>(summary.loops));
  }
}

/// A path as a shell takes it.
std::string shell_word(const std::string& path) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%";
  if (!path.empty() && path.find_first_not_of(kPlain) == std::string::npos) return path;
  std::string word = "'";
  for (const char c : path) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// What is next: the commands that show the run.
void print_next(const std::filesystem::path& out) {
  const std::string run = shell_word(out.string());
  std::printf("to see it: isobar web %s (in a browser), or isobar report %s (one HTML file)\n", run.c_str(),
              run.c_str());
}

/// Folder of the run where none is named: beside nothing of the user's, in the current folder, with the source's name.
std::filesystem::path default_out(const std::filesystem::path& source) {
  std::error_code error;
  std::filesystem::path whole = std::filesystem::absolute(source, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();
  std::string name = std::filesystem::is_directory(whole, error) ? whole.filename() : whole.stem();
  if (name.empty()) name = "isobar";
  return name + "-run";
}

/// A run that is already in the folder is kept unless its removal is asked for.
/// @throws UsageError
void refuse_run(const ReplayOptions& options) {
  if (options.replace || !files::holds_run(options.out)) return;
  throw UsageError("--out: " + options.out.string() +
                   " holds a run already; name another folder, or add --replace to delete that run");
}

/// The stored map is not in the folder that the run replaces.
/// @throws UsageError
void refuse_own_map(const ReplayOptions& options) {
  if (options.map.empty()) return;
  const auto out = std::filesystem::weakly_canonical(options.out);
  const auto map = std::filesystem::weakly_canonical(options.map);
  if (std::mismatch(out.begin(), out.end(), map.begin(), map.end()).first != out.end()) return;
  throw UsageError("--out: " + options.out.string() + " holds the stored map; name another folder");
}

/// The configuration with what the command line sets in it.
/// @throws UsageError
Config config_of(const ReplayOptions& options, Config config) {
  if (!options.method.empty()) {
    const auto method = kMethodNames.value(options.method);
    if (!method)
      throw UsageError("--method: \"" + options.method + "\" is none of " + method_names() +
                       did_you_mean(options.method, kMethodNames.names()));
    config.method = *method;
  }
  if (!options.map.empty()) config.map_files.stored = options.map;
  if (!options.map_use.empty()) {
    const auto use = kMapUseNames.value(options.map_use);
    if (!use) throw UsageError("--map-use: \"" + options.map_use + "\" is none of extend, localise, new");
    config.map_files.use = *use;
  }
  return config;
}

/// Replays; of a run that is stopped by a signal, or has no scan, nothing stays.
ReplaySummary replay_or_remove(const std::filesystem::path& recording, const Config& config,
                               const std::filesystem::path& out) {
  std::error_code error;
  const bool is_new = !std::filesystem::exists(out, error);
  const auto remove = [&] {
    if (!is_new) return files::remove_run(out);
    std::filesystem::remove_all(out, error);
  };
  try {
    Progress progress("replaying");
    return replay(recording, config, out, [&](double fraction) {
      StopSignals::check();
      progress.update(fraction);
    });
  } catch (const Stopped&) {
    remove();
    throw;
  } catch (const DataError&) {
    remove();
    throw;
  } catch (const ServiceError& full) {
    if (files::has_no_pose(out, files::newest_session(out))) {
      remove();
      throw;
    }
    throw ServiceError(std::string(full.what()) + "; " + out.string() +
                       " holds what was written before, and is no whole run");
  }
}

void run_replay(ReplayOptions options) {
  if (options.out.empty()) options.out = default_out(options.recording);
  refuse_own_map(options);
  refuse_run(options);
  const StopSignals signals;
  const LoadedConfig loaded = options.config.empty() ? LoadedConfig{} : load_layers(options.config);
  const Config config = config_of(options, loaded.config);
  const ImportedRecording recording(options);
  // Before a run is removed: a recording that cannot be read must not cost it.
  std::vector<std::string> warnings;
  const recording::Manifest manifest = recording::read_manifest(recording.folder(), warnings);
  if (!manifest.lidar && !is_recording(options.recording)) {
    throw DataError(options.recording.string() +
                    ": holds no lidar that is read (the table says what it holds): there is nothing to map");
  }
  for (const std::string& sentence : overridden_settings(loaded, with_sensors_of(manifest, loaded.config)))
    std::printf("note: %s\n", sentence.c_str());
  if (files::holds_run(options.out)) files::remove_run(options.out);
  const ReplaySummary summary = replay_or_remove(recording.folder(), config, options.out);
  print_summary(summary, recording);
  print_written(options.out);
  print_next(options.out);
}

}  // namespace

void add_replay_command(CLI::App& app) {
  const auto [command, options] =
      add_subcommand<ReplayOptions>(app, "replay", "Estimate poses and a map from a recording", run_replay);
  command
      .add_option(
          "RECORDING", options.recording,
          "recording folder, or what isobar import reads: it is imported into a temporary folder first")
      ->required();
  command.add_option("--keep", options.keep, "folder in which the imported recording is kept");
  command.add_option("--config", options.config,
                     "TOML file; its sensors and mounts are replaced by the recording's");
  command.add_option("--method", options.method, method_names() + " (default: the configuration's)");
  command.add_option(
      "--out", options.out,
      "folder for trajectory.tum, map.ply, map/, status.csv, settings.toml (default: NAME-run in the "
      "current folder, for a recording NAME)");
  command.add_option("--map", options.map,
                     "stored map in which the robot is, the folder of a run or of a map; it stays as it is");
  command.add_option(
      "--map-use", options.map_use,
      "extend (default): add to a copy of it in the folder of this run; localise: add nothing; new: do "
      "not use it");
  command.add_flag("--replace", options.replace, "delete the run that is in the folder");
  add_import_options(command, options.import);
}

}  // namespace isobar::tools
