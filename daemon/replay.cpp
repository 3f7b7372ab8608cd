// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/replay.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "daemon/counts.hpp"
#include "daemon/lock_step.hpp"
#include "daemon/stage_settings.hpp"
#include "drivers/recording/recording_reader.hpp"

namespace isobar {

namespace {

/// Writes what the pipeline makes, and remembers which height and method it worked with.
class OutputSink : public EstimateSink {
 public:
  explicit OutputSink(RunOutput& output) : output_(output) {}
  void on_pose(const PoseEstimate& pose, const Prior& prior) override {
    output_.add_pose(pose, prior);
    if (pose.mode != PoseMode::kRegistered) return;
    ran_as_asked_ += pose.effective_method == pose.method ? 1 : 0;
    ran_otherwise_ += pose.effective_method == pose.method ? 0 : 1;
  }
  void on_evicted(const std::vector<MapPoint>& points) override { output_.add_map_points(points); }

  [[nodiscard]] std::uint64_t ran_otherwise() const { return ran_otherwise_; }
  [[nodiscard]] std::uint64_t ran_as_asked() const { return ran_as_asked_; }

 private:
  RunOutput& output_;
  std::uint64_t ran_as_asked_ = 0;
  std::uint64_t ran_otherwise_ = 0;
};

void say_what_is_missing(const recording::Manifest& manifest, ReplaySummary& summary) {
  if (!manifest.barometer) summary.warnings.emplace_back("no [barometer]: 3-DOF runs as 4-DOF");
  if (manifest.barometer && !manifest.base_barometer) {
    summary.warnings.emplace_back(
        "no [base_barometer]: the height is against the robot's own start, weather moves it");
  }
  if (!manifest.wheel) summary.warnings.emplace_back("no [wheel]: constant velocity between scans");
}

std::vector<RunCount> collect_counts(const recording::RecordingReader& reader, const LockStep& pipeline) {
  std::vector<RunCount> counts;
  for (const recording::Count& count : reader.counts())
    counts.push_back({count.name, count.count, count.first_message});
  append(counts, counts_of(pipeline.decoder().counters(), pipeline.decoder().wrong_model_message()));
  append(counts, counts_of(pipeline.prior_estimator().counters()));
  counts.push_back({"map cells seen through", pipeline.map().seen_through_count(), ""});
  return counts;
}

/// A scan that nobody could decode must not end in an empty trajectory without a word.
void refuse_empty_run(const ReplaySummary& summary, const LockStep& pipeline,
                      const std::filesystem::path& recording) {
  if (summary.scans > 0) return;
  const auto& lidar = pipeline.decoder().counters();
  std::string why = "no lidar scan could be decoded";
  if (lidar.wrong_model > 0) why += ": " + pipeline.decoder().wrong_model_message();
  throw DataError(recording.string() + ": " + why);
}

}  // namespace

ReplaySummary replay(const std::filesystem::path& recording, const Config& config,
                     const std::filesystem::path& out, const std::function<void(double)>& progress) {
  const auto started = std::chrono::steady_clock::now();
  recording::RecordingReader reader(recording);
  const Config used = with_sensors_of(reader.manifest(), config);
  ReplaySummary summary;
  summary.warnings = reader.warnings();
  say_what_is_missing(reader.manifest(), summary);
  if (reader.manifest().base_barometer) summary.base_clock = reader.base_clock().reason;

  RunOutput output(out);
  output.write_settings(show_config(used));
  OutputSink sink(output);
  LockStep pipeline(stage_settings(used), sink);
  recording::Event event;
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    first_ns = std::min(first_ns, event.stamp_ns);
    last_ns = std::max(last_ns, event.stamp_ns);
    pipeline.handle(event);
    if (events % 512 == 0) progress(reader.progress());
  }
  pipeline.finish();

  summary.scans = pipeline.scans();
  summary.poses = output.poses();
  summary.registered = output.registered();
  summary.from_prior = output.from_prior();
  summary.map_points = output.map_points();
  summary.recorded_s = last_ns > first_ns ? static_cast<double>(last_ns - first_ns) * 1e-9 : 0.0;
  summary.counts = collect_counts(reader, pipeline);
  if (sink.ran_otherwise() > 0 && reader.manifest().barometer) {
    summary.warnings.emplace_back("no height from pressure for " + std::to_string(sink.ran_otherwise()) +
                                  " scans: 3-DOF ran as 4-DOF there");
  }
  output.close(summary.counts);
  refuse_empty_run(summary, pipeline, recording);
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return summary;
}

}  // namespace isobar
