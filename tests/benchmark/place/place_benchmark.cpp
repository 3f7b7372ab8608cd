// SPDX-License-Identifier: BSD-3-Clause
// Cold starts at simulated places of a stored map: the run of another seed's sensor errors, weather and people. The robot
// stands anywhere along the way of the run, up to some decimetres beside it, with any heading.
// Usage: bench_place RUN SCENARIO SEED [PLACES [SCANS [SIGMA_M [QUERY_SEED]]]]; RUN: folder of `isobar replay --out` of the
// recording SCENARIO, SEED; SCENARIO-short: its short form. Default: 200 places, 3 scans, height known to 0.15 m.
// Prints a line for every place that is not found, and a summary.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.hpp"
#include "core/place/cold_start.hpp"
#include "core/so3.hpp"
#include "run/tile_store/file_tile_store.hpp"
#include "simulated_place.hpp"
#include "simulation/scenario_list.hpp"

namespace {

using namespace isobar;  // NOLINT(google-build-using-namespace): a program
namespace fs = std::filesystem;

constexpr double kRightM = 0.3;
constexpr double kRightDeg = 3.0;
constexpr std::string_view kShort = "-short";
constexpr double kFloorM = 1.5;
constexpr double kLeastFit = 0.75;  // as daemon/place_stage.cpp

struct Options {
  fs::path run;
  std::string scenario;
  bool short_form = false;
  std::uint64_t seed = 1;
  int places = 200;
  int scans = 3;
  double sigma_m = 0.15;
  std::uint64_t query_seed = 77;
};

struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_map_base;
};

std::vector<StampedPose> read_trajectory(const fs::path& file) {
  std::ifstream in(file);
  std::vector<StampedPose> poses;
  std::string line;
  while (std::getline(in, line)) {
    long long s = 0;
    double v[7];          // NOLINT(modernize-avoid-c-arrays): for sscanf
    char fraction[16]{};  // NOLINT(modernize-avoid-c-arrays)
    if (std::sscanf(line.c_str(), "%lld.%15[0-9] %lf %lf %lf %lf %lf %lf %lf", &s, fraction, v, v + 1, v + 2,
                    v + 3, v + 4, v + 5, v + 6) != 9) {
      continue;
    }
    std::string digits = fraction;
    digits.resize(9, '0');
    StampedPose pose;
    pose.stamp_ns = s * 1'000'000'000 + std::atoll(digits.c_str());
    pose.T_map_base = Eigen::Isometry3d::Identity();
    pose.T_map_base.translation() << v[0], v[1], v[2];
    pose.T_map_base.linear() = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix();
    poses.push_back(pose);
  }
  return poses;
}

// As in simulation/simulate.cpp.
std::int64_t start_ns(std::uint64_t seed) {
  simulation::Random start(seed, "start");
  return 1'700'000'000'000'000'000 + std::llround(start.uniform(0.0, 3e7) * 1e9);
}

double thread_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

KnownMap read_map(const fs::path& folder) {
  const auto store = FileTileStore::open_to_read(folder);
  KnownMap map(static_cast<float>(store->header().cell_m));
  std::vector<std::byte> bytes;
  for (const TileKey& key : store->keys()) {
    if (store->take(key, bytes)) map.add_tile(key, bytes);
  }
  map.finish();
  return map;
}

struct Tally {
  int right = 0, wrong = 0, wrong_floor = 0, unknown = 0, ambiguous = 0, ambiguous_with_truth = 0, twins = 0,
      incomplete = 0;
  std::vector<double> seconds;

  void print() {
    std::sort(seconds.begin(), seconds.end());
    const auto at = [this](double share) {
      return seconds[static_cast<std::size_t>(share * double(seconds.size() - 1))];
    };
    std::printf(
        "%zu places: right %d, wrong %d, of these on a wrong floor %d, unknown %d, ambiguous %d (%d with the "
        "right one;"
        " %d between places that an exact lidar does not tell apart); search cut short %d;"
        " CPU median %.3f s, p99 %.3f s, worst %.3f s\n",
        seconds.size(), right, wrong, wrong_floor, unknown, ambiguous, ambiguous_with_truth, twins,
        incomplete, at(0.5), at(0.99), at(1.0));
  }
};

bool is_right(const Eigen::Isometry3d& T, const Eigen::Isometry3d& truth) {
  const double turn = rotation_angle_rad(Eigen::Quaterniond(T.linear().transpose() * truth.linear()));
  return (T.translation() - truth.translation()).norm() < kRightM && turn < kRightDeg * kRadPerDeg;
}

void print_place(const ColdStartResult& result, const Eigen::Isometry3d& truth,
                 const ColdStartResult& there) {
  const Eigen::Vector3d p = truth.translation();
  std::printf("  at %7.2f %7.2f %6.2f yaw %6.1f, tried %zu:", p.x(), p.y(), p.z(),
              std::atan2(truth.linear()(1, 0), truth.linear()(0, 0)) / kRadPerDeg, result.tried);
  for (std::size_t i = 0; i < std::min<std::size_t>(result.candidates.size(), 3); ++i) {
    const PlaceCandidate& one = result.candidates[i];
    const Eigen::Vector3d d = one.T_map_base.translation() - p;
    const double turn =
        rotation_angle_rad(Eigen::Quaterniond(one.T_map_base.linear().transpose() * truth.linear()));
    std::printf(" [%.2f %.2f %.2f %.1f deg, walls %.3f others %.3f passed %.3f w %.3f]", d.x(), d.y(), d.z(),
                turn / kRadPerDeg, one.fit.walls, one.fit.others, one.fit.passed, one.weight);
  }
  if (there.candidates.empty()) std::printf(" truth: none");
  for (const PlaceCandidate& one : there.candidates) {
    std::printf(" truth: [%.2f m, walls %.3f passed %.3f]", (one.T_map_base.translation() - p).norm(),
                one.fit.walls, one.fit.passed);
    break;
  }
  std::printf("\n");
}

/// A robot that stands somewhere.
struct Question {
  SimulatedPlace place;
  Eigen::Isometry3d T_map_base;  ///< the answer
  LevelledScans scans;
  double z_m;  ///< as the altimeter has it
};

Question draw_question(const Options& options, const simulation::Scenario& scenario,
                       const std::vector<StampedPose>& way, int number) {
  simulation::Random random(options.query_seed, "place", static_cast<std::uint64_t>(number));
  const double spread_m = scenario.tracked ? 0.2 : 0.5;
  const StampedPose& at = way[random.next() % way.size()];
  const double time_s = 1e-9 * static_cast<double>(at.stamp_ns - start_ns(options.seed));
  const simulation::MotionState state = scenario.trajectory.at(time_s);
  Eigen::Isometry3d T_base_place = Eigen::Isometry3d::Identity();
  T_base_place.linear() = rotation_about_z(random.uniform(-kPi, kPi));
  T_base_place.translation() << random.normal(spread_m), random.normal(spread_m), 0.0;
  Question question;
  question.place.T_world_base = Eigen::Isometry3d::Identity();
  question.place.T_world_base.linear() = state.q_world_base.toRotationMatrix();
  question.place.T_world_base.translation() = state.p_world;
  question.place.T_world_base = question.place.T_world_base * T_base_place;
  question.place.time_s = random.uniform(0.0, scenario.trajectory.duration_s());
  question.place.scans = options.scans;
  question.T_map_base = at.T_map_base * T_base_place;
  question.scans = scans_at(scenario, question.place, random);
  question.z_m = question.T_map_base.translation().z() + random.normal(options.sigma_m);
  return question;
}

/// Another candidate looks as the right place does.
bool has_twin(const ColdStartResult& result, const Question& question, const simulation::Scenario& scenario) {
  constexpr double kSameShare = 0.03;
  return std::any_of(result.candidates.begin(), result.candidates.end(), [&](const PlaceCandidate& one) {
    if (is_right(one.T_map_base, question.T_map_base)) return false;
    const Eigen::Isometry3d T_world_other =
        question.place.T_world_base * question.T_map_base.inverse() * one.T_map_base;
    return different_share(scenario, question.place.T_world_base, T_world_other) < kSameShare;
  });
}

/// False where the robot says that it does not know.
bool is_answer(const ColdStartResult& result) {
  if (result.candidates.empty()) return false;
  return result.verdict == ColdStartVerdict::kAmbiguous || result.candidates.front().fit.score() >= kLeastFit;
}

void count(const ColdStartResult& result, const Question& question, const simulation::Scenario& scenario,
           Tally& tally) {
  tally.incomplete += result.complete ? 0 : 1;
  if (!is_answer(result)) {
    ++tally.unknown;
    return;
  }
  const Eigen::Isometry3d& truth = question.T_map_base;
  const Eigen::Isometry3d& best = result.candidates.front().T_map_base;
  if (result.verdict == ColdStartVerdict::kAmbiguous) {
    ++tally.ambiguous;
    tally.twins += has_twin(result, question, scenario) ? 1 : 0;
    tally.ambiguous_with_truth +=
        std::any_of(result.candidates.begin(), result.candidates.end(),
                    [&](const auto& one) { return is_right(one.T_map_base, truth); });
  } else if (is_right(best, truth)) {
    ++tally.right;
  } else {
    ++tally.wrong;
    const double climb_m = best.translation().z() - truth.translation().z();
    tally.wrong_floor += std::abs(climb_m) > kFloorM ? 1 : 0;
  }
}

int run(const Options& options) {
  const KnownMap map = read_map(options.run / "map");
  // Loops move the map: the corrected trajectory is in its frame.
  const fs::path corrected = options.run / "trajectory-corrected.tum";
  const std::vector<StampedPose> way =
      read_trajectory(fs::exists(corrected) ? corrected : options.run / "trajectory.tum");
  const simulation::Scenario scenario =
      simulation::find_scenario(options.scenario).make(options.seed, options.short_form);
  std::printf("map: %zu voxels of structure, %zu planes; %zu poses\n", map.structure().voxel_count(),
              map.snapshot()->plane_count(), way.size());
  ColdStart cold_start;
  PlaceQuery query;
  Tally tally;
  for (int i = 0; i < options.places; ++i) {
    const Question question = draw_question(options, scenario, way, i);
    const double begin_s = thread_s();
    query.clear();
    for (const auto& points : question.scans.p_level) query.add(points, question.scans.p_level_lidar);
    query.finish();
    const ColdStartInput input{map, query, question.scans.R_level_base, {question.z_m, options.sigma_m}};
    const ColdStartResult result = cold_start.locate(input);
    tally.seconds.push_back(thread_s() - begin_s);
    count(result, question, scenario, tally);
    const Eigen::Isometry3d& truth = question.T_map_base;
    if (result.verdict == ColdStartVerdict::kFound && is_answer(result) &&
        is_right(result.candidates.front().T_map_base, truth)) {
      continue;
    }
    const double yaw_rad = std::atan2(truth.linear()(1, 0), truth.linear()(0, 0));
    const SearchArea hint{truth.translation().x(), truth.translation().y(), yaw_rad, {0.15, 0.15}, 0.03};
    print_place(result, truth, cold_start.locate(input, hint));
  }
  tally.print();
  return tally.wrong_floor > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: bench_place RUN SCENARIO SEED [PLACES [SCANS [SIGMA_M [QUERY_SEED]]]]\n");
    return 64;
  }
  try {
    Options options{.run = argv[1], .scenario = argv[2]};
    options.seed = static_cast<std::uint64_t>(std::atoll(argv[3]));
    options.short_form = options.scenario.ends_with(kShort);
    if (options.short_form) options.scenario.resize(options.scenario.size() - kShort.size());
    if (argc > 4) options.places = std::atoi(argv[4]);
    if (argc > 5) options.scans = std::atoi(argv[5]);
    if (argc > 6) options.sigma_m = std::atof(argv[6]);
    if (argc > 7) options.query_seed = static_cast<std::uint64_t>(std::atoll(argv[7]));
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_place: %s\n", error.what());
    return 1;
  }
}
