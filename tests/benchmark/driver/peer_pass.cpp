// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/peer_pass.hpp"

#include <memory>
#include <utility>

#include "core/geometry.hpp"
#include "core/registration/motion_model.hpp"
#include "daemon/cpu_time.hpp"
#include "tests/benchmark/driver/passes.hpp"
#include "tests/benchmark/driver/system_under_test.hpp"

namespace isobar::bench {

namespace {

/// A peer with its motion model and map updates.
class PeerRunner {
 public:
  PeerRunner(std::unique_ptr<Peer> peer, const StageSettings& settings)
      : peer_(std::move(peer)), settings_(settings), motion_(settings.registration) {
    run_.name = peer_->name();
  }

  void take(std::span<const ScanPoint> cloud, const Prior& end) {
    if (!motion_.started()) motion_.start(end);
    const Prediction prediction = motion_.predict(end, traits_of(settings_.method, end.height_source));
    const CpuTimer registering;
    const PeerResult result = peer_->register_cloud(cloud, prediction.T_map_base);
    run_.registration_ms.push_back(registering.elapsed_ms());
    if (result.converged) {
      motion_.correct(end, result.T_map_base);
    } else {
      motion_.keep_prediction(end, prediction);
      ++run_.failures;
    }
    run_.poses.push_back(stamped(end.stamp_ns, result.T_map_base));

    double map_ms = 0.0;
    if (wants(end.stamp_ns, result.T_map_base)) {
      const CpuTimer updating;
      peer_->update_map(cloud, result.T_map_base);
      map_ms = updating.elapsed_ms();
      T_map_base_taken_ = result.T_map_base;
      taken_ns_ = end.stamp_ns;
    }
    run_.map_ms.push_back(map_ms);
  }

  SystemRun finish() { return std::move(run_); }

 private:
  [[nodiscard]] bool wants(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) const {
    const Eigen::Isometry3d step = T_map_base_taken_.inverse() * T_map_base;
    return taken_ns_ == 0 || step.translation().norm() > settings_.map.update_distance_m ||
           Eigen::AngleAxisd(step.linear()).angle() > settings_.map.update_angle_deg * kRadPerDeg ||
           static_cast<double>(stamp_ns - taken_ns_) * 1e-9 > settings_.map.update_interval_s;
  }

  std::unique_ptr<Peer> peer_;
  StageSettings settings_;
  MotionModel motion_;
  Eigen::Isometry3d T_map_base_taken_ = Eigen::Isometry3d::Identity();
  std::int64_t taken_ns_ = 0;
  SystemRun run_;
};

class PeerSink : public ScanSink {
 public:
  PeerSink(const StageSettings& settings, std::vector<std::unique_ptr<Peer>> peers, std::size_t max_scans)
      : system_(settings),
        deskewing_(settings),
        out_(std::make_unique<RegisteredScan>()),
        max_scans_(max_scans) {
    pass_.ours.name = "isobar";
    for (std::unique_ptr<Peer>& peer : peers) runners_.emplace_back(std::move(peer), settings);
  }

  void on_prior(const Prior& prior) override {
    if (done()) return;
    system_.add_prior(prior);
    deskewing_.add_prior(prior);
  }

  void on_scan(const Scan& scan, double /*decode_ms*/) override {
    if (done()) return;
    const CpuTimer registering;
    system_.register_scan(scan, *out_);
    const double registration_ms = registering.elapsed_ms();
    const CpuTimer updating;
    if (system_.update_map(*out_)) system_.hand_over();
    const double map_ms = updating.elapsed_ms();

    Prior end;
    const std::span<const ScanPoint> cloud = deskewing_.deskew(scan, end);
    if (!end.attitude_valid) return;  // our registration has not started either
    pass_.ours.registration_ms.push_back(registration_ms);
    pass_.ours.map_ms.push_back(map_ms);
    pass_.ours.poses.push_back(stamped(out_->pose.stamp_ns, out_->pose.T_map_base));
    pass_.ours.failures += out_->pose.mode == PoseMode::kPriorOnly ? 1 : 0;
    for (PeerRunner& runner : runners_) runner.take(cloud, end);
  }

  [[nodiscard]] bool done() const override { return pass_.ours.poses.size() >= max_scans_; }

  PeerPass finish() {
    for (PeerRunner& runner : runners_) pass_.peers.push_back(runner.finish());
    return std::move(pass_);
  }

 private:
  SystemUnderTest system_;
  StageProbe deskewing_;
  std::unique_ptr<RegisteredScan> out_;
  std::vector<PeerRunner> runners_;
  std::size_t max_scans_;
  PeerPass pass_;
};

}  // namespace

PeerPass measure_peers(DataSet& data, std::vector<std::unique_ptr<Peer>> peers, std::size_t max_scans) {
  PeerSink sink(data.settings(), std::move(peers), max_scans);
  data.play(sink);
  return sink.finish();
}

}  // namespace isobar::bench
