// SPDX-License-Identifier: BSD-3-Clause
// Recording folder as a data set: decoder and prior estimator in lock step, as in `isobar replay`.
#include <deque>
#include <optional>
#include <utility>

#include "config/config.hpp"
#include "daemon/cpu_time.hpp"
#include "daemon/stage_settings.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/reference.hpp"
#include "tests/benchmark/driver/data_set.hpp"

namespace isobar::bench {

namespace {

// Limit of scans that wait for priors, as in LockStep: with more of them the IMU is silent.
constexpr std::size_t kMaxWaitingScans = 4;

/// One pass over a recording.
///
/// Reading the thread's clock costs as much as decoding half a packet. Events are therefore delayed until
/// there is a batch of packets, which is decoded at once; the clock is read around the batch and at the end
/// of a scan. Then the events continue in their original order.
class RecordingPass {
 public:
  RecordingPass(const StageSettings& settings, ScanSink& sink)
      : sink_(sink),
        decoder_(make_lidar_decoder(settings.lidar)),
        priors_(settings.prior),
        filling_(std::make_unique<Scan>()) {}

  void handle(const recording::Event& event) {
    events_.push_back({event, {}, nullptr, 0.0});
    if (event.kind != recording::EventKind::kLidarPacket) return;
    events_.back().packet.assign(event.packet.begin(), event.packet.end());
    if (++packets_ == kBatch) release_batch();
  }

  void finish() {
    release_batch();
    const CpuTimer timer;
    if (decoder_.flush(*filling_)) {
      waiting_.push_back({std::move(filling_), decode_ms_ + timer.elapsed_ms()});
    }
    hand_out(true);
  }

 private:
  struct Waiting {
    std::unique_ptr<Scan> scan;
    double decode_ms;
  };
  struct Buffered {
    recording::Event event;
    std::vector<std::uint8_t> packet;
    std::unique_ptr<Scan> scan;  // completed by this packet
    double decode_ms;            // CPU time of decoding that scan
  };
  static constexpr std::size_t kBatch = 16;

  void release_batch() {
    decode_batch();
    for (Buffered& buffered : events_) take(buffered);
    events_.clear();
    packets_ = 0;
  }

  void decode_batch() {
    std::optional<CpuTimer> timer(std::in_place);
    for (Buffered& buffered : events_) {
      if (buffered.packet.empty()) continue;
      if (!decoder_.add_packet(buffered.packet, buffered.event.stamp_ns, *filling_).scan_complete) continue;
      buffered.decode_ms = decode_ms_ + timer->elapsed_ms();
      buffered.scan = std::move(filling_);
      filling_ = spare_ ? std::move(spare_) : std::make_unique<Scan>();
      decode_ms_ = 0.0;
      timer.emplace();
    }
    decode_ms_ += timer->elapsed_ms();
  }

  void take(Buffered& buffered) {
    switch (buffered.event.kind) {
      case recording::EventKind::kLidarPacket:
        if (!buffered.scan) break;
        waiting_.push_back({std::move(buffered.scan), buffered.decode_ms});
        hand_out(false);
        break;
      case recording::EventKind::kImu:
        take_imu(buffered.event.imu);
        break;
      case recording::EventKind::kPressure:
        priors_.add_pressure(buffered.event.pressure);
        break;
      case recording::EventKind::kBasePressure:
        priors_.add_base_pressure(buffered.event.pressure);
        break;
      case recording::EventKind::kWheel:
        priors_.add_wheel(buffered.event.wheel);
        break;
      case recording::EventKind::kCloud:
        break;
    }
  }

  void take_imu(const ImuSample& sample) {
    Prior prior;
    if (!priors_.add_imu(sample, prior)) return;
    newest_prior_ns_ = prior.stamp_ns;
    sink_.on_prior(prior);
    hand_out(false);
  }

  void hand_out(bool all) {
    while (!waiting_.empty() && (all || waiting_.size() > kMaxWaitingScans ||
                                 newest_prior_ns_ >= waiting_.front().scan->end_stamp_ns)) {
      sink_.on_scan(*waiting_.front().scan, waiting_.front().decode_ms);
      spare_ = std::move(waiting_.front().scan);
      waiting_.pop_front();
    }
  }

  ScanSink& sink_;
  ScanAssembler decoder_;
  PriorEstimator priors_;
  std::vector<Buffered> events_;
  std::size_t packets_ = 0;
  double decode_ms_ = 0.0;
  std::unique_ptr<Scan> filling_;
  std::unique_ptr<Scan> spare_;
  std::deque<Waiting> waiting_;
  std::int64_t newest_prior_ns_ = std::numeric_limits<std::int64_t>::min();
};

evaluation::Trajectory reference_of(const std::filesystem::path& folder,
                                    const recording::Manifest& manifest) {
  if (!manifest.reference) return {};
  std::vector<evaluation::StampedPose> poses;
  for (const recording::StampedPose& pose : recording::read_tum(folder / manifest.reference->file)) {
    poses.push_back({pose.stamp_ns, pose.T_map_base.translation(),
                     Eigen::Quaterniond(pose.T_map_base.linear()).normalized()});
  }
  return evaluation::make_trajectory(std::move(poses));
}

class RecordingSet : public DataSet {
 public:
  RecordingSet(std::filesystem::path folder, const DataSetOptions& options)
      : folder_(std::move(folder)), stop_after_s_(options.stop_after_s) {
    name_ = folder_.filename().string();
    const recording::RecordingReader reader(folder_);
    settings_ = stage_settings(with_sensors_of(reader.manifest(), options.config));
    reference_ = reference_of(folder_, reader.manifest());
  }

  void play(ScanSink& sink) override {
    recording::RecordingReader reader(folder_);
    RecordingPass pass(settings_, sink);
    recording::Event event;
    std::optional<std::int64_t> first_ns;
    while (!sink.done() && reader.next(event)) {
      if (!first_ns) first_ns = event.stamp_ns;
      if (static_cast<double>(event.stamp_ns - *first_ns) * 1e-9 > stop_after_s_) break;
      pass.handle(event);
    }
    pass.finish();
  }

 private:
  std::filesystem::path folder_;
  double stop_after_s_;
};

}  // namespace

std::unique_ptr<DataSet> open_recording(const std::filesystem::path& folder, const DataSetOptions& options) {
  return std::make_unique<RecordingSet>(folder, options);
}

}  // namespace isobar::bench
