// SPDX-License-Identifier: BSD-3-Clause
// Restarts without loss, in lock step: a recording is replayed, and every few seconds a second pipeline continues
// from what isobard would have on the disk at that moment: tiles, journal, checkpoint. How soon does it confirm its
// place, and is it the right one?
// Usage: bench_restart RECORDING [EVERY_S] [PAUSE_S]; default: every 5 s, 1.3 s from the kill to the first sample.
// Prints a line for every restart that is late or wrong, and a summary.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/geometry.hpp"
#include "core/names.hpp"
#include "core/so3.hpp"
#include "core/stamp.hpp"
#include "daemon/checkpoint_draft.hpp"
#include "daemon/lock_step.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/tile_store/scan_journal.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a program
namespace fs = std::filesystem;

constexpr double kWrongM = 0.5;        // a wrong place
constexpr double kLateS = 3.0;         // promised
constexpr double kFollowedForS = 2.0;  // after the confirmation
constexpr double kGiveUpS = 12.0;

class Poses final : public EstimateSink {
 public:
  void on_pose(const PoseEstimate& pose, const Prior& /*prior*/) override { last = pose; }
  PoseEstimate last;
};

/// The run that is killed.
class Original {
 public:
  Original(const Config& config, const fs::path& folder)
      : folder_(folder),
        store_(FileTileStore::create(folder, map_header(config), map_limits(config))),
        journal_(folder),
        pipeline_(stage_settings(config), poses_, store_.get()) {}

  void handle(const recording::Event& event) {
    pipeline_.handle(event);
    if (poses_.last.stamp_ns != noted_ns_) note();
    if (event.stamp_ns - written_ns_ >= 1'000'000'000) write_tiles(event.stamp_ns);
    if (event.stamp_ns - checkpoint_ns_ >= 500'000'000 && draft_.due()) {
      checkpoint_ns_ = event.stamp_ns;
      checkpoint_ = draft_.at(event.stamp_ns, pipeline_.prior_estimator().height_datum());
    }
  }
  [[nodiscard]] const files::Checkpoint& checkpoint() const { return checkpoint_; }
  [[nodiscard]] const Eigen::Isometry3d* pose_at(std::int64_t stamp_ns) const {
    const auto found = truth_.find(stamp_ns);
    return found == truth_.end() ? nullptr : &found->second;
  }

 private:
  void note() {
    noted_ns_ = poses_.last.stamp_ns;
    truth_[noted_ns_] = poses_.last.T_map_base;
    draft_.note(poses_.last);
    const RegisteredScan& scan = pipeline_.registered_scan();
    if (scan.pose.stamp_ns == noted_ns_ && scan.point_count > 0) journal_.add(scan);
  }
  void write_tiles(std::int64_t now_ns) {
    written_ns_ = now_ns;
    if (pipeline_.map().sweep_begins()) journal_.begin_sweep(true);
    pipeline_.map().store_some();
  }

  fs::path folder_;
  std::unique_ptr<FileTileStore> store_;
  ScanJournal journal_;
  Poses poses_;
  LockStep pipeline_;
  CheckpointDraft draft_;
  files::Checkpoint checkpoint_;
  std::map<std::int64_t, Eigen::Isometry3d> truth_;
  std::int64_t noted_ns_ = 0;
  std::int64_t written_ns_ = 0;
  std::int64_t checkpoint_ns_ = 0;
};

/// A run that continues from the disk.
class Continuation {
 public:
  Continuation(const Config& config, const fs::path& folder, const Original& killed, std::int64_t killed_ns,
               std::int64_t begin_ns)
      : killed_ns_(killed_ns),
        begin_ns_(begin_ns),
        start_(continuation_of(killed.checkpoint())),
        store_(FileTileStore::open_to_read(folder)),
        pipeline_(stage_settings(config), poses_, store_.get()) {
    pipeline_.continue_from(start_, folder);
  }

  /// False when nothing is left to be seen.
  bool handle(const recording::Event& event, const Original& original) {
    if (event.stamp_ns < begin_ns_) return true;
    pipeline_.handle(event);
    if (poses_.last.stamp_ns != seen_ns_) judge(original);
    const double limit_s = confirmed() ? confirmed_s + kFollowedForS : kGiveUpS;
    return seconds_between(killed_ns_, event.stamp_ns) < limit_s && poses_.last.session <= start_.session;
  }
  [[nodiscard]] bool confirmed() const { return confirmed_s > 0.0; }
  [[nodiscard]] double killed_s(std::int64_t first_ns) const { return seconds_between(first_ns, killed_ns_); }
  [[nodiscard]] const PoseEstimate& last() const { return poses_.last; }
  [[nodiscard]] const RunStart& start() const { return start_; }

  double confirmed_s = 0.0;      // after the kill
  double first_error_m = 0.0;    // when it was confirmed
  double largest_error_m = 0.0;  // from then on

 private:
  void judge(const Original& original) {
    seen_ns_ = poses_.last.stamp_ns;
    if (poses_.last.mode == PoseMode::kInitializing || poses_.last.session != start_.session) return;
    const Eigen::Isometry3d* truth = original.pose_at(seen_ns_);
    if (truth == nullptr) return;
    const double error_m = (poses_.last.T_map_base.translation() - truth->translation()).norm();
    if (!confirmed()) {
      confirmed_s = seconds_between(killed_ns_, seen_ns_);
      first_error_m = error_m;
    }
    largest_error_m = std::max(largest_error_m, error_m);
  }

  std::int64_t killed_ns_;
  std::int64_t begin_ns_;
  RunStart start_;
  std::unique_ptr<FileTileStore> store_;
  Poses poses_;
  LockStep pipeline_;
  std::int64_t seen_ns_ = 0;
};

struct Tally {
  std::vector<double> seconds;
  int restarts = 0, late = 0, wrong = 0, new_frames = 0, never = 0;
  double largest_error_m = 0.0;

  void add(const Continuation& run, std::int64_t first_ns) {
    ++restarts;
    const bool new_frame = run.last().session > run.start().session;
    const bool is_late = run.confirmed_s > kLateS;
    const bool is_wrong = run.largest_error_m > kWrongM;
    new_frames += new_frame ? 1 : 0;
    late += is_late ? 1 : 0;
    wrong += is_wrong ? 1 : 0;
    never += !run.confirmed() && !new_frame ? 1 : 0;
    if (run.confirmed()) {
      seconds.push_back(run.confirmed_s);
      largest_error_m = std::max(largest_error_m, run.largest_error_m);
    }
    if (!new_frame && !is_late && !is_wrong && run.confirmed()) return;
    const Eigen::Vector3d p = run.start().place->T_map_base.translation();
    const Eigen::Vector3d v = run.start().place->v_map_m_s;
    std::printf(
        "kill at %6.1f s  (%7.2f %7.2f %7.2f) m  (%5.2f %5.2f %5.2f) m/s  overlap %.2f  %s after %4.1f s"
        "  error %.2f, then %.2f m\n",
        run.killed_s(first_ns), p.x(), p.y(), p.z(), v.x(), v.y(), v.z(), run.start().place->overlap,
        new_frame ? "NEW FRAME" : (run.confirmed() ? "confirmed" : "NEVER"), run.confirmed_s,
        run.first_error_m, run.largest_error_m);
  }
  void print() {
    std::sort(seconds.begin(), seconds.end());
    const auto at = [this](double share) {
      return seconds.empty() ? 0.0 : seconds[static_cast<std::size_t>(share * double(seconds.size() - 1))];
    };
    std::printf(
        "%d restarts: %d new frames, %d never confirmed, %d later than %.0f s, %d more than %.1f m off;"
        " confirmed after %.2f s (median), %.2f s (p99); largest error %.2f m\n",
        restarts, new_frames, never, late, kLateS, wrong, kWrongM, at(0.5), at(0.99), largest_error_m);
  }
};

int run(const fs::path& folder, double every_s, double pause_s) {
  recording::RecordingReader reader(folder);
  Config config = with_sensors_of(reader.manifest(), Config{});
  if (const char* method = std::getenv("ISOBAR_METHOD")) config.method = kMethodNames.value(method).value();
  const fs::path map = fs::temp_directory_path() / ("isobar-restart-" + std::to_string(::getpid()));
  Original original(config, map);
  std::vector<std::unique_ptr<Continuation>> open;
  Tally tally;
  std::mt19937 random{1};
  std::uniform_real_distribution<double> around(0.5 * every_s, 1.5 * every_s);
  std::int64_t first_ns = 0;
  std::int64_t next_ns = 0;
  recording::Event event;
  while (reader.next(event)) {
    if (first_ns == 0) {
      first_ns = event.stamp_ns;
      next_ns = first_ns + std::int64_t{8'000'000'000};
    }
    original.handle(event);
    if (event.stamp_ns >= next_ns) {
      next_ns += static_cast<std::int64_t>(around(random) * 1e9);
      const std::int64_t begin_ns = event.stamp_ns + static_cast<std::int64_t>(pause_s * 1e9);
      open.push_back(std::make_unique<Continuation>(config, map, original, event.stamp_ns, begin_ns));
    }
    for (auto& one : open) {
      if (one->handle(event, original)) continue;
      tally.add(*one, first_ns);
      one.reset();
    }
    std::erase(open, nullptr);
  }
  tally.print();
  fs::remove_all(map);
  return tally.new_frames + tally.never + tally.wrong + tally.late > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_restart RECORDING [EVERY_S] [PAUSE_S]\n");
    return 64;
  }
  try {
    return run(argv[1], argc > 2 ? std::atof(argv[2]) : 5.0, argc > 3 ? std::atof(argv[3]) : 1.3);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_restart: %s\n", error.what());
    return 1;
  }
}
