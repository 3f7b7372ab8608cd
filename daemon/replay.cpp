// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/mounts/mount_text.hpp"
#include "core/names.hpp"
#include "core/stamp.hpp"
#include "daemon/base_station_names.hpp"
#include "daemon/checkpoint_draft.hpp"
#include "daemon/counts.hpp"
#include "daemon/lidar_clock.hpp"
#include "daemon/lock_step.hpp"
#include "daemon/missing_sensors.hpp"
#include "daemon/recording_check.hpp"
#include "daemon/replay_maps.hpp"
#include "daemon/silent_lidar.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar {
namespace {

/// Scans from which on their rate is judged.
constexpr std::uint64_t kMinScansForRate = 20;
/// Share of the progress that the check of the inputs takes.
constexpr double kCheckShare = 0.1;

/// Writes the poses; counts the scans whose registration fell back to a method with fewer inputs than the
/// configured one.
class OutputSink : public EstimateSink {
 public:
  OutputSink(files::RunOutput& output, files::StationNames stations)
      : output_(output), checkpoint_(std::move(stations)) {}
  void on_pose(const PoseEstimate& pose, const Prior& prior) override {
    checkpoint_.note(pose);
    // Of a robot that is not found in its map nobody knows the pose.
    if (pose.covariance(0, 0) > 0.0 && place_unknown(pose)) {
      ++unknown_;
      last_ = pose;
      return;
    }
    output_.add_pose(pose, prior);
    if (pose.lost != LostReason::kNone) note_lost(pose);
    last_ = pose;
    if (pose.mode != PoseMode::kRegistered) return;
    if (pose.effective_method == pose.method) return;
    const bool without_imu = pose.effective_method == Method::k6Dof && pose.method != Method::k6DofAltitude;
    without_imu_ += without_imu ? 1 : 0;
    without_height_ += without_imu ? 0 : 1;
  }

  /// Times that the robot was lost, in one line; empty: never.
  [[nodiscard]] std::string lost_text() const {
    if (lost_ == 0) return {};
    std::string text = "lost " + std::to_string(lost_) + (lost_ == 1 ? " time" : " times") + ", " +
                       std::to_string(lost_poses_) + " poses: ";
    return text + std::string(kLostReasonTexts.name(first_reason_)) + (lost_ == 1 ? "" : " (the first)") +
           "; dead reckoning there, not mapped";
  }
  /// Scans registered without a height from pressure, and without an IMU.
  [[nodiscard]] std::uint64_t without_height() const { return without_height_; }
  [[nodiscard]] std::uint64_t without_imu() const { return without_imu_; }
  /// Scans of a robot that had not been found in its map.
  [[nodiscard]] std::uint64_t unknown() const { return unknown_; }
  [[nodiscard]] const CheckpointDraft& checkpoint() const { return checkpoint_; }
  /// The last pose.
  [[nodiscard]] const PoseEstimate& last() const { return last_; }

 private:
  void note_lost(const PoseEstimate& pose) {
    if (lost_ == 0) first_reason_ = pose.lost;
    if (pose.lost_since_ns != lost_since_ns_) ++lost_;
    lost_since_ns_ = pose.lost_since_ns;
    ++lost_poses_;
  }

  files::RunOutput& output_;
  CheckpointDraft checkpoint_;
  std::uint64_t unknown_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t lost_poses_ = 0;
  std::int64_t lost_since_ns_ = 0;
  LostReason first_reason_ = LostReason::kNone;
  PoseEstimate last_;
  std::uint64_t without_height_ = 0;
  std::uint64_t without_imu_ = 0;
};

void warn_of_missing_sensors(const recording::Manifest& manifest, const Config& config,
                             ReplaySummary& summary) {
  const auto texts = missing_sensor_texts({.imu = config.imu.present(),
                                           .wheels = manifest.wheel.has_value(),
                                           .barometer = config.barometer.present(),
                                           .base_station = manifest.base_barometer.has_value()});
  summary.warnings.insert(summary.warnings.end(), texts.begin(), texts.end());
}

std::vector<files::RunCount> collect_counts(const recording::RecordingReader& reader,
                                            const LockStep& pipeline) {
  std::vector<files::RunCount> counts;
  for (const recording::Count& count : reader.counts())
    counts.push_back({count.name, count.count, count.first_message});
  run_counts::append(counts,
                     counts_of(pipeline.assembler().counters(), pipeline.assembler().decoder().mismatch()));
  run_counts::append(counts, pipeline.clouds().counts());
  counts.push_back({"lidar packets of another sender", pipeline.lidar_sender().refused, ""});
  run_counts::append(counts, counts_of(pipeline.prior_estimator().counters()));
  counts.push_back({"map cells seen through", pipeline.map().seen_through_count(), ""});
  return counts;
}

void warn_of_no_pose(ReplaySummary& summary) {
  const char* few = "too few scans: those that begin the map are all";
  const char* none = "no scan could be registered: all poses are the prior's";
  if (summary.registered == 0) summary.warnings.emplace_back(summary.from_prior > 0 ? none : few);
}

/// Warns of sensors in the manifest without a single usable sample. counters.csv has the reasons.
void warn_of_unusable_sensors(const recording::Manifest& manifest, const Config& config,
                              const LockStep& pipeline, ReplaySummary& summary) {
  const PriorCounters& used = pipeline.prior_estimator().counters();
  const auto warn = [&](bool named, std::uint64_t samples, const char* what) {
    if (named && samples == 0) summary.warnings.emplace_back(what);
  };
  warn(config.imu.present(), used.imu_accepted,
       "the [imu] gave no usable sample: gravity and motion are unknown");
  warn(manifest.barometer.has_value(), used.pressure_accepted,
       "the [barometer] gave no usable sample: 3-DOF runs as 4-DOF");
  warn(manifest.base_barometer.has_value(), used.base_accepted,
       "the [base_barometer] gave no usable sample: the height is relative to the start");
  warn(manifest.wheel.has_value(), used.wheel_accepted,
       "the [wheel] gave no usable sample: constant velocity between scans");
  warn_of_no_pose(summary);
}

/// Warns of scans that lacked a source of their pose, and of those whose pose was lost.
void warn_of_scans_without(const recording::Manifest& manifest, bool has_imu, const OutputSink& sink,
                           ReplaySummary& summary) {
  if (sink.without_height() > 0 && manifest.barometer) {
    summary.warnings.emplace_back("no height from pressure for " + std::to_string(sink.without_height()) +
                                  " scans: 3-DOF ran as 4-DOF there");
  }
  if (sink.without_imu() > 0 && has_imu) {
    summary.warnings.emplace_back("the IMU was silent for " + std::to_string(sink.without_imu()) +
                                  " scans: they were registered as 6-DOF");
  }
  if (const std::string lost = sink.lost_text(); !lost.empty()) summary.warnings.push_back(lost);
}

/// Warns of packets of a second lidar, and of a rate of scans that no lidar has.
void warn_of_two_lidars(const LockStep& pipeline, std::uint16_t port, ReplaySummary& summary) {
  const SenderStatus& senders = pipeline.lidar_sender();
  if (senders.refused > 0) {
    summary.warnings.emplace_back("packets of " + ipv4_text(senders.in_use.ipv4) + " and of " +
                                  ipv4_text(senders.other.ipv4) + " on UDP port " + std::to_string(port) +
                                  ": those of " + ipv4_text(senders.in_use.ipv4) + " are used, " +
                                  std::to_string(senders.refused) + " others are not; lidar.sender chooses");
  }
  const double rate_hz =
      summary.recorded_s > 0.0 ? static_cast<double>(summary.scans) / summary.recorded_s : 0.0;
  if (summary.scans >= kMinScansForRate && rate_hz > kFastestScanHz) {
    summary.warnings.emplace_back(std::to_string(std::lround(rate_hz)) +
                                  " scans per second: no lidar turns that fast; do two of them send from one "
                                  "address?");
  }
}

/// Places seen again, and the maps laid anew for them.
void describe_loops(const LoopStage& loops, ReplaySummary& summary) {
  summary.loops = loops.counts().taken;
  run_counts::append(summary.counts, counts_of(loops.counts()));
  summary.counts.push_back({"maps laid anew", loops.moves(), loops.problem()});
  if (!loops.problem().empty()) summary.warnings.push_back("loops: " + loops.problem());
}

/// The contradictions in the status of the run.
void add_contradictions(const std::vector<std::string>& texts, std::vector<files::RunCount>& counts) {
  for (const std::string& text : texts) counts.push_back({"contradiction", 1, text});
}

/// A recording without a decodable scan is an error, not an empty trajectory.
void refuse_empty_run(const ReplaySummary& summary, const recording::RecordingReader& reader,
                      const LockStep& pipeline, const std::filesystem::path& recording) {
  if (summary.scans > 0) return;
  throw DataError(recording.string() +
                  ": no lidar scan could be decoded: " + silent_lidar_text(reader, pipeline.assembler()));
}

/// Says what became of the search of the place in the stored map.
void describe_place(const LockStep& pipeline, const OutputSink& sink, ReplaySummary& summary) {
  const PlaceStatus& place = pipeline.place();
  if (place.found > 0) {
    summary.warnings.emplace_back(
        "the place was found in the map by " + std::to_string(place.searches) +
        (place.searches == 1 ? " search" : " searches") + " of all of it" +
        (place.refused > 0 ? ", " + std::to_string(place.refused) + " not confirmed" : ""));
  }
  if (place.given_up > 0) {
    summary.warnings.emplace_back(
        "no place of the stored map fits what the robot saw at the start: it is kept, and a new map frame "
        "began");
  }
  if (sink.unknown() > 0) {
    summary.warnings.emplace_back("no pose for " + std::to_string(sink.unknown()) +
                                  " scans: the place in the map was not known yet");
  }
  const std::string text = place_text(place);
  if (!text.empty() && !place.carried) summary.warnings.push_back(text);
}

/// Feeds all events to the pipeline.
/// @return time from the first to the last event [s]
double feed(recording::RecordingReader& reader, const UsableSensors& usable, LockStep& pipeline,
            const std::function<void(double)>& progress) {
  recording::Event event;
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    first_ns = std::min(first_ns, event.stamp_ns);
    last_ns = std::max(last_ns, event.stamp_ns);
    if (is_used(event.kind, usable)) pipeline.handle(event);
    if (events % 512 == 0) progress(kCheckShare + (1.0 - kCheckShare) * reader.progress());
  }
  pipeline.finish();
  return last_ns > first_ns ? seconds_between(first_ns, last_ns) : 0.0;
}

void describe_output(const files::RunOutput& output, ReplaySummary& summary) {
  summary.poses = output.poses();
  summary.registered = output.registered();
  summary.from_prior = output.from_prior();
  summary.map_points = output.map_points();
}

void describe_clouds(const LockStep& pipeline, ReplaySummary& summary) {
  const std::string clouds = pipeline.clouds().sentence();
  if (!clouds.empty()) summary.warnings.push_back("lidar clouds: " + clouds);
}

}  // namespace

ReplaySummary replay(const std::filesystem::path& recording, const Config& config,
                     const std::filesystem::path& out, const std::function<void(double)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  recording::RecordingReader reader(recording);
  // Before the first pose: what the whole recording contradicts is left out of the run from its start.
  const RecordingCheck check = check_recording(recording, with_sensors_of(reader.manifest(), config),
                                               [&](double fraction) { progress(kCheckShare * fraction); });
  refuse_clocks_apart(check, recording);
  const recording::Manifest manifest = without_unusable(reader.manifest(), check.usable);
  const Config used = with_sensors_of(manifest, config);
  reader.use_lidar_clock(lidar_clock(stage_settings(used).lidar));
  ReplaySummary summary;
  summary.warnings = reader.warnings();
  const std::vector<std::string> contradictions = contradiction_texts(check);
  summary.warnings.insert(summary.warnings.end(), contradictions.begin(), contradictions.end());
  warn_of_missing_sensors(manifest, used, summary);
  if (manifest.base_barometer) summary.base_clock = reader.base_clock().reason;

  files::RunOutput output(out);
  output.write_settings(run_settings(used));
  OutputSink sink(output, station_names(used));
  ReplayMaps maps(used, out);
  LockStep pipeline(stage_settings(used), sink, maps.storage(), maps.loop_files(used),
                    [&] { return maps.exchange(); });
  maps.begin(pipeline, summary.warnings);
  summary.recorded_s = feed(reader, check.usable, pipeline, progress);
  output.flush();
  maps.write_checkpoint(sink.checkpoint(), pipeline.prior_estimator().height_datum());
  if (used.loops.enabled) write_corrected_trajectories(out, pipeline.loops());
  const std::vector<files::RunCount> map_counts = counts_of_map(maps.store(), output);

  summary.scans = pipeline.scans();
  describe_output(output, summary);
  summary.counts = collect_counts(reader, pipeline);
  run_counts::append(summary.counts, map_counts);
  describe_loops(pipeline.loops(), summary);
  add_contradictions(contradictions, summary.counts);
  warn_of_scans_without(manifest, used.imu.present(), sink, summary);
  describe_place(pipeline, sink, summary);
  describe_clouds(pipeline, summary);
  warn_of_two_lidars(pipeline, used.lidar.port, summary);
  warn_of_unusable_sensors(manifest, used, pipeline, summary);
  output.write_counters(summary.counts);
  if (used.method == Method::kAdaptive) {
    output.write_mounts(mounts_file_text(sink.last().mount, used.lidar.mount.rpy_deg));
  }
  refuse_empty_run(summary, reader, pipeline, recording);
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return summary;
}

}  // namespace isobar
