// SPDX-License-Identifier: BSD-3-Clause
// Folder of clouds as a data set: no IMU, no wheels, no times of points.
#include "config/config.hpp"
#include "core/errors.hpp"
#include "daemon/stage_settings.hpp"
#include "tests/benchmark/driver/cloud_file.hpp"
#include "tests/benchmark/driver/data_set.hpp"

namespace isobar::bench {

namespace {

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
// Assumed time between two clouds, which have no stamps: with 0.4 s the constant-velocity model allows the
// motion of a walk or a car between two of them.
constexpr std::int64_t kStepNs = 400'000'000;

/// Prior of an unknown platform: upright, with unknown motion.
Prior ignorant_prior(std::int64_t stamp_ns) {
  constexpr double kTurnRateRadS = 0.15;
  Prior prior;
  prior.stamp_ns = stamp_ns;
  prior.attitude_valid = true;
  prior.yaw_rate_variance_rad2_s2 = kTurnRateRadS * kTurnRateRadS;
  return prior;
}

class CloudSet : public DataSet {
 public:
  CloudSet(const std::filesystem::path& folder, const DataSetOptions& options) : files_(cloud_files(folder)) {
    if (files_.empty()) {
      throw DataError(folder.string() + ": holds no recording.toml, no *.pcd and no *.bin");
    }
    const double most = options.stop_after_s * 1e9 / static_cast<double>(kStepNs) + 1.0;
    if (most < static_cast<double>(files_.size())) files_.resize(static_cast<std::size_t>(most));
    name_ = folder.filename().string();
    settings_ = stage_settings(options.config);
    settings_.method = Method::k6Dof;
    settings_.T_base_lidar = Eigen::Isometry3d::Identity();
  }

  void play(ScanSink& sink) override {
    const auto scan = std::make_unique<Scan>();
    std::int64_t stamp_ns = kStartNs;
    for (const std::filesystem::path& file : files_) {
      if (sink.done()) break;
      read_cloud(file, *scan);
      scan->stamp_ns = scan->end_stamp_ns = stamp_ns;
      scan->sequence = static_cast<std::uint32_t>((stamp_ns - kStartNs) / kStepNs);
      sink.on_prior(ignorant_prior(stamp_ns));
      sink.on_scan(*scan, 0.0);  // no packets to decode
      stamp_ns += kStepNs;
    }
  }

 private:
  std::vector<std::filesystem::path> files_;
};

}  // namespace

std::unique_ptr<DataSet> open_clouds(const std::filesystem::path& folder, const DataSetOptions& options) {
  return std::make_unique<CloudSet>(folder, options);
}

}  // namespace isobar::bench
