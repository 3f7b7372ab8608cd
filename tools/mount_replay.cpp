// SPDX-License-Identifier: BSD-3-Clause
#include "tools/mount_replay.hpp"

#include <cmath>

#include "core/errors.hpp"
#include "core/mounts/corrected_mount.hpp"
#include "core/stamp.hpp"
#include "daemon/lidar_clock.hpp"
#include "daemon/lock_step.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/recording_reader.hpp"

namespace isobar::tools {

namespace {

/// Turn about z by the wheels, trapezoids between samples.
class WheelTurn {
 public:
  void add(const WheelSample& sample) {
    const double dt_s = seconds_between(last_.stamp_ns, sample.stamp_ns);
    if (started_ && dt_s > 0.0 && dt_s < kLongestGapS)
      sum_rad_ += 0.5 * dt_s * (last_.wz_rad_s + sample.wz_rad_s);
    if (started_ && dt_s >= kLongestGapS) sum_rad_ = std::numeric_limits<double>::quiet_NaN();
    last_ = sample;
    started_ = true;
  }
  /// The turn since the last call; NaN where unknown.
  double take() {
    const double turn_rad = started_ ? sum_rad_ : std::numeric_limits<double>::quiet_NaN();
    sum_rad_ = 0.0;
    return turn_rad;
  }

 private:
  static constexpr double kLongestGapS = 0.5;
  WheelSample last_;
  double sum_rad_ = 0.0;
  bool started_ = false;
};

/// Priors of its own, since the pipeline keeps its: the same samples give the same priors.
class MountSink : public EstimateSink {
 public:
  MountSink(const StageSettings& settings, const Eigen::Quaterniond& q_configured)
      : q_used_(settings.T_base_lidar.linear()), prior_(settings.prior), estimator_(q_configured) {}

  void add(const recording::Event& event) {
    Prior prior;
    if (event.kind == recording::EventKind::kImu && prior_.add_imu(event.imu, prior)) {
      result_.turn_deg += turn_deg_since_last(prior);
      history_.add(prior);
    }
    if (event.kind != recording::EventKind::kWheel) return;
    prior_.add_wheel(event.wheel);
    wheel_turn_.add(event.wheel);
  }

  void on_pose(const PoseEstimate& pose, const Prior& /*prior*/) override {
    if (pose.mode != PoseMode::kRegistered) return;
    ScanMotionEvidence scan;
    scan.stamp_ns = pose.stamp_ns;
    scan.session = pose.session;
    scan.T_map_base = pose.T_map_base;
    scan.q_base_lidar = q_used_;
    scan.wheel_turn_rad = wheel_turn_.take();
    estimator_.add(scan, history_);
    if (result_.registered++ > 0) result_.way_m += (pose.T_map_base.translation() - p_last_m_).norm();
    p_last_m_ = pose.T_map_base.translation();
  }

  [[nodiscard]] MountReplay result(std::uint64_t scans) const {
    MountReplay out = result_;
    out.estimate = estimator_.estimate();
    out.scans = scans;
    return out;
  }

 private:
  [[nodiscard]] double turn_deg_since_last(const Prior& prior) const {
    if (history_.empty() || !prior.attitude_valid) return 0.0;
    const double dt_s = seconds_between(history_.newest().stamp_ns, prior.stamp_ns);
    return dt_s < kLongestTurnStepS && !prior.standing_still ? prior.w_base_rad_s.norm() * dt_s / kRadPerDeg
                                                             : 0.0;
  }

  static constexpr double kLongestTurnStepS = 0.1;
  Eigen::Quaterniond q_used_;
  PriorEstimator prior_;
  PriorHistory history_;
  MountEstimator estimator_;
  WheelTurn wheel_turn_;
  MountReplay result_;
  Eigen::Vector3d p_last_m_ = Eigen::Vector3d::Zero();
};

// Error of a step's rotation [deg]: the scans are to be compared with the gyro, not held by it.
constexpr double kFreeStepDeg = 0.2;

}  // namespace

MountReplay replay_for_mount(const std::filesystem::path& recording, const Config& config,
                             const Eigen::Vector3d& error_rad, const std::function<void(double)>& progress) {
  recording::RecordingReader reader(recording);
  if (!reader.manifest().imu) {
    throw DataError(recording.string() + ": recording.toml: no [imu]: mounts are found against the gyro");
  }
  const Config used = with_sensors_of(reader.manifest(), config);
  StageSettings settings = stage_settings(used);
  reader.use_lidar_clock(lidar_clock(settings.lidar));
  const Eigen::Vector3d configured_rpy_deg = used.lidar.mount.rpy_deg;
  settings.method = Method::k6Dof;
  settings.registration.step_rotation_floor_deg = kFreeStepDeg;
  settings.T_base_lidar.linear() = corrected_rotation(configured_rpy_deg, error_rad);
  MountSink sink(settings, Eigen::Quaterniond(rotation_from_rpy_deg(configured_rpy_deg)));
  LockStep pipeline(settings, sink);
  recording::Event event;
  for (std::uint64_t events = 0; reader.next(event); ++events) {
    sink.add(event);  // before the pipeline, whose poses need the priors
    pipeline.handle(event);
    if (events % 512 == 0) progress(reader.progress());
  }
  pipeline.finish();
  MountReplay result = sink.result(pipeline.scans());
  result.configured_rpy_deg = configured_rpy_deg;
  return result;
}

}  // namespace isobar::tools
