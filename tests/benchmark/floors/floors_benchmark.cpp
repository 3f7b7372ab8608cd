// SPDX-License-Identifier: BSD-3-Clause
// Floors as isobard tells them while the robot drives, in lock step, against the truth: wrong floors, the time until the
// floor is told, and the cost of floors and grids.
// Usage: bench_floors RECORDING
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "core/stamp.hpp"
#include "daemon/cpu_time.hpp"
#include "daemon/floor_stage.hpp"
#include "daemon/lock_step.hpp"
#include "run/evaluation/evaluated_run.hpp"
#include "run/recording/recording_reader.hpp"
#include "tools/true_floors.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a program

constexpr std::int64_t kRoundNs = 1'000'000'000;

class Poses final : public EstimateSink {
 public:
  void on_pose(const PoseEstimate& pose, const Prior& /*prior*/) override { last = pose; }
  PoseEstimate last;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const char* what, const std::vector<double>& values, const char* unit) {
  std::printf("%-44s median %8.2f  p99 %8.2f  worst %8.2f %s  (%zu)\n", what, quantile(values, 0.5),
              quantile(values, 0.99), quantile(values, 1.0), unit, values.size());
}

/// The thread of the floors, in lock step: a round a second.
class Floors1Hz {
 public:
  void take(const PoseEstimate& pose, const LocalMap& map) {
    const CpuTimer step;
    feed_.step(map, nullptr, pose.T_map_base.translation());
    step_ms.push_back(step.elapsed_ms());
    stage_.add_pose(pose);
    stage_.add_tiles(feed_.take());
    if (pose.stamp_ns - asked_ns_ >= kRoundNs / 2) {
      feed_.ask();
      asked_ns_ = pose.stamp_ns;
    }
    if (pose.stamp_ns - round_ns_ >= kRoundNs) {
      round_ns_ = pose.stamp_ns;
      const CpuTimer find;
      stage_.find();
      find_ms.push_back(find.elapsed_ms());
    }
    now = stage_.current();
    const bool is_other = now.known && grid_floor_ != now.number;
    if (!is_other && round_ns_ != pose.stamp_ns) return;
    if (!is_other && ++rounds_ % 20 != 0) return;  // grids are measured, not needed
    const CpuTimer grid;
    if (stage_.grid()) grid_ms.push_back(grid.elapsed_ms());
    grid_floor_ = now.number;
  }

  ipc::CurrentFloor now;
  std::vector<double> step_ms, find_ms, grid_ms;

 private:
  FloorFeed feed_;
  FloorStage stage_{GridConfig{}};
  std::int64_t asked_ns_ = 0, round_ns_ = 0;
  std::optional<std::int32_t> grid_floor_;
  int rounds_ = 0;
};

/// Comparison of the told floors with the truth.
class Tally {
 public:
  explicit Tally(const evaluation::ReferenceData& reference) : reference_(reference), truth_(reference) {}

  void note(std::int64_t stamp_ns, const ipc::CurrentFloor& told) {
    while (next_ + 1 < reference_.trajectory.poses.size() &&
           reference_.trajectory.poses[next_].stamp_ns < stamp_ns) {
      ++next_;
    }
    const std::optional<int> number = truth_.number_at(reference_.trajectory.poses[next_]);
    if (number != on_) {
      on_ = number;
      since_ns_ = stamp_ns;
      is_told_ = false;
    }
    if (!number) return;
    ++poses;
    if (!told.known) return;
    ++known;
    if (told.number != *number) {
      ++wrong;
      ++wrong_as[{*number, told.number}];
    } else if (!is_told_) {
      is_told_ = true;
      (visited_[*number]++ == 0 ? first_s : later_s).push_back(seconds_between(since_ns_, stamp_ns));
    }
  }

  std::size_t poses = 0, known = 0, wrong = 0;
  std::map<std::pair<int, int>, int> wrong_as;
  std::vector<double> first_s, later_s;

 private:
  const evaluation::ReferenceData& reference_;
  tools::TrueFloors truth_;
  std::size_t next_ = 0;
  std::optional<int> on_;
  std::int64_t since_ns_ = 0;
  bool is_told_ = false;
  std::map<int, int> visited_;
};

void run(const std::filesystem::path& recording) {
  recording::RecordingReader reader(recording);
  const Config config = with_sensors_of(reader.manifest(), Config{});
  Poses poses;
  LockStep pipeline(stage_settings(config), poses);
  const evaluation::ReferenceData reference = evaluation::load_reference(recording);
  Floors1Hz floors;
  Tally tally(reference);
  std::int64_t noted_ns = 0;
  recording::Event event;
  while (reader.next(event)) {
    pipeline.handle(event);
    if (poses.last.stamp_ns == noted_ns) continue;
    noted_ns = poses.last.stamp_ns;
    floors.take(poses.last, pipeline.map());
    tally.note(noted_ns, floors.now);
  }
  std::printf("%zu poses on a floor, %zu with a known one, %zu with a wrong one\n", tally.poses, tally.known,
              tally.wrong);
  for (const auto& [pair, count] : tally.wrong_as) {
    std::printf("  floor %d told as %d: %d poses\n", pair.first, pair.second, count);
  }
  print("first arrival on a floor, until it is told", tally.first_s, "s");
  print("later arrivals", tally.later_s, "s");
  print("a scan's time for the feed", floors.step_ms, "ms");
  print("finding the floors", floors.find_ms, "ms");
  print("a grid", floors.grid_ms, "ms");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: bench_floors RECORDING\n");
    return 64;
  }
  try {
    run(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_floors: %s\n", error.what());
    return 1;
  }
}
