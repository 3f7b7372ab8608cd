// SPDX-License-Identifier: BSD-3-Clause
// bench_standing: recorded scans of a sensor at rest in a loop; how far does the pose go?
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "core/names.hpp"
#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/system_under_test.hpp"

namespace isobar::bench {

namespace {

struct Options {
  std::string data;
  std::string method = "4dof";
  std::string config;
  double seconds = 30.0;
  double noise_m = 0.0;
  std::size_t skip = 0;
  bool every = false;
};

// Scans of a data set, with as much of their memory as they need.
class ScanList : public ScanSink {
 public:
  void on_prior(const Prior& /*prior*/) override {}
  void on_scan(const Scan& scan, double /*decode_ms*/) override {
    scans.emplace_back(scan.points, scan.points + scan.point_count);
    lengths_ns.push_back(scan.end_stamp_ns - scan.stamp_ns);
  }
  std::vector<std::vector<ScanPoint>> scans;
  std::vector<std::int64_t> lengths_ns;
};

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr std::int64_t kImuPeriodNs = 5'000'000;

Prior prior_at_rest(std::int64_t stamp_ns) {
  Prior prior;
  prior.stamp_ns = stamp_ns;
  prior.attitude_valid = true;
  prior.standing_still = stamp_ns > kStartNs + 1'000'000'000;
  prior.roll_pitch_variance_rad2 = 1e-6;
  prior.yaw_rate_variance_rad2_s2 = 1e-6;
  return prior;
}

// Range noise, independent of scan and point.
void disturb(std::vector<ScanPoint>& points, double noise_m, std::mt19937& random) {
  std::normal_distribution<float> noise(0.0F, static_cast<float>(noise_m));
  for (ScanPoint& p : points) {
    const float range = std::sqrt(p.x_m * p.x_m + p.y_m * p.y_m + p.z_m * p.z_m);
    const float factor = 1.0F + noise(random) / std::max(range, 0.1F);
    p.x_m *= factor;
    p.y_m *= factor;
    p.z_m *= factor;
  }
}

// Largest distances from the first pose along each axis [m], and of yaw [rad].
struct Excursion {
  Eigen::Vector3d first_second_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d later_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;

  void add(bool early, const Eigen::Isometry3d& T_map_base) {
    Eigen::Vector3d& largest_m = early ? first_second_m : later_m;
    largest_m = largest_m.cwiseMax(T_map_base.translation().cwiseAbs());
    yaw_rad = std::max(yaw_rad, std::abs(std::atan2(T_map_base(1, 0), T_map_base(0, 0))));
  }
};

// A robot at rest that sees the scans of a list in turn.
class StandingRun {
 public:
  StandingRun(const Options& options, const StageSettings& settings, const ScanList& list)
      : options_(options), list_(list), system_(settings) {}

  void step(std::size_t i) {
    fill(i);
    for (; prior_ns_ <= scan_->end_stamp_ns; prior_ns_ += kImuPeriodNs)
      system_.add_prior(prior_at_rest(prior_ns_));
    system_.register_scan(*scan_, *out_);
    if (system_.update_map(*out_)) system_.hand_over();
    const PoseEstimate& pose = out_->pose;
    registered_ += pose.mode == PoseMode::kRegistered ? 1 : 0;
    excursion_.add(i <= 10, pose.T_map_base);
    if (!options_.every) return;
    const Eigen::Vector3d p_mm = pose.T_map_base.translation() * 1e3;
    std::printf("%5zu %8.3f %8.3f %8.3f mm  pairs %u of %u  rms %.4f m\n", i, p_mm.x(), p_mm.y(), p_mm.z(),
                pose.matched_pairs, pose.sampled_points, pose.residual_rms_m);
  }

  void print(const std::string& name, std::size_t count) const {
    const Eigen::Vector3d early_mm = excursion_.first_second_m * 1e3;
    const Eigen::Vector3d later_mm = excursion_.later_m * 1e3;
    std::printf(
        "%-24s %-5s largest x y z in the first second %6.2f %6.2f %6.2f mm, later %6.2f %6.2f %6.2f mm, yaw "
        "%.3f deg, "
        "%zu of %zu registered\n",
        name.c_str(), options_.method.c_str(), early_mm.x(), early_mm.y(), early_mm.z(), later_mm.x(),
        later_mm.y(), later_mm.z(), excursion_.yaw_rad / kRadPerDeg, registered_, count);
  }

 private:
  void fill(std::size_t i) {
    const std::size_t at = options_.skip + i % (list_.scans.size() - options_.skip);
    std::vector<ScanPoint> points = list_.scans[at];
    if (options_.noise_m > 0.0) disturb(points, options_.noise_m, random_);
    std::copy(points.begin(), points.end(), scan_->points);
    scan_->point_count = static_cast<std::uint32_t>(points.size());
    scan_->sequence = static_cast<std::uint32_t>(i);
    scan_->end_stamp_ns = kStartNs + static_cast<std::int64_t>(i) * kPeriodNs;
    scan_->stamp_ns = scan_->end_stamp_ns - list_.lengths_ns[at];
  }

  const Options& options_;
  const ScanList& list_;
  SystemUnderTest system_;
  std::mt19937 random_{1};
  std::unique_ptr<Scan> scan_ = std::make_unique<Scan>();
  std::unique_ptr<RegisteredScan> out_ = std::make_unique<RegisteredScan>();
  std::int64_t prior_ns_ = kStartNs - kPeriodNs;
  std::size_t registered_ = 0;
  Excursion excursion_;
};

void run(const Options& options) {
  DataSetOptions data_options;
  if (!options.config.empty()) data_options.config = load_config(options.config);
  const std::unique_ptr<DataSet> data = open_data_set(options.data, data_options);
  ScanList list;
  data->play(list);
  if (list.scans.size() <= options.skip)
    throw DataError(options.data + ": holds no scan after the skipped ones");
  StageSettings settings = data->settings();
  const auto method = kMethodNames.value(options.method);
  if (!method) throw UsageError("--method: must be one of " + kMethodNames.joined());
  settings.method = *method;
  const auto count = static_cast<std::size_t>(options.seconds * 1e9 / kPeriodNs);
  StandingRun standing(options, settings, list);
  for (std::size_t i = 0; i < count; ++i) standing.step(i);
  standing.print(data->name(), count);
}

}  // namespace

}  // namespace isobar::bench

int main(int argc, char** argv) {
  CLI::App app{"bench_standing: recorded scans of a sensor at rest in a loop"};
  isobar::bench::Options options;
  app.add_option("DATA", options.data, "recording folder, or folder of *.pcd or *.bin")->required();
  app.add_option("--method", options.method)->capture_default_str();
  app.add_option("--config", options.config);
  app.add_option("--seconds", options.seconds)->capture_default_str();
  app.add_option("--noise", options.noise_m, "range noise added, standard deviation [m]")
      ->capture_default_str();
  app.add_option("--skip", options.skip, "leave out the first scans")->capture_default_str();
  app.add_flag("--every", options.every, "print every pose");
  CLI11_PARSE(app, argc, argv);
  try {
    isobar::bench::run(options);
  } catch (const isobar::Error& error) {
    std::fprintf(stderr, "bench_standing: %s\n", error.what());
    return error.exit_code();
  }
  return 0;
}
