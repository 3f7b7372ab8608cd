// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/passes.hpp"

#include "daemon/cpu_time.hpp"
#include "tests/support/allocation_count.hpp"

namespace isobar::bench {

namespace {

using test::allocation_count;

// Scans between two measurements of the memory: each returns free memory to the system, which costs the next
// scans page faults.
constexpr std::size_t kMemoryInterval = 100;

HardwareCounts difference(const HardwareCounts& after, const HardwareCounts& before) {
  return {after.instructions - before.instructions, after.cache_misses - before.cache_misses};
}

class MeasuringSink : public ScanSink {
 public:
  MeasuringSink(const StageSettings& settings, bool look_at_memory)
      : system_(settings), out_(std::make_unique<RegisteredScan>()), look_at_memory_(look_at_memory) {
    pass_.refusals = counters_.refusals();
    remember_size();
  }

  void on_prior(const Prior& prior) override { system_.add_prior(prior); }

  void on_scan(const Scan& scan, double decode_ms) override {
    ScanCosts costs;
    costs.decode_ms = decode_ms;
    measure_registration(scan, costs);
    measure_map(costs);
    pass_.poses.push_back(stamped(out_->pose.stamp_ns, out_->pose.T_map_base));
    pass_.scans.push_back(costs);
    if (pass_.scans.size() % kMemoryInterval == 0) remember_size();
  }

  Pass finish() {
    if (pass_.memory.back().scan != pass_.scans.size()) remember_size();
    return std::move(pass_);
  }

 private:
  void measure_registration(const Scan& scan, ScanCosts& costs) {
    const HardwareCounts counts = counters_.read();
    const std::size_t allocations = allocation_count();
    const CpuTimer timer;
    system_.register_scan(scan, *out_);
    costs.registration_ms = timer.elapsed_ms();
    costs.registration_allocations = allocation_count() - allocations;
    costs.registration_counts = difference(counters_.read(), counts);
    costs.registered = out_->pose.mode == PoseMode::kRegistered;
  }

  void measure_map(ScanCosts& costs) {
    const HardwareCounts counts = counters_.read();
    const std::size_t allocations = allocation_count();
    const CpuTimer updating;
    costs.map_changed = system_.update_map(*out_);
    costs.map_ms = updating.elapsed_ms();
    if (costs.map_changed) {
      const CpuTimer handing_over;
      system_.hand_over();
      costs.hand_over_ms = handing_over.elapsed_ms();
    }
    costs.map_allocations = allocation_count() - allocations;
    costs.map_counts = difference(counters_.read(), counts);
  }

  void remember_size() {
    pass_.memory.push_back({pass_.scans.size(), system_.cell_count(), system_.plane_count(),
                            system_.tile_count(), look_at_memory_ ? resident_bytes() : 0});
  }

  SystemUnderTest system_;
  HardwareCounters counters_;
  std::unique_ptr<RegisteredScan> out_;
  bool look_at_memory_;
  Pass pass_;
};

class SplittingSink : public ScanSink {
 public:
  explicit SplittingSink(const StageSettings& settings)
      : system_(settings), probe_(settings), out_(std::make_unique<RegisteredScan>()) {}

  void on_prior(const Prior& prior) override {
    system_.add_prior(prior);
    probe_.add_prior(prior);
  }

  void on_scan(const Scan& scan, double /*decode_ms*/) override {
    const CpuTimer timer;
    system_.register_scan(scan, *out_);
    const double registration_ms = timer.elapsed_ms();
    if (out_->pose.mode == PoseMode::kRegistered) {
      stages_.push_back(probe_.split(scan, system_.snapshot(), *out_, registration_ms));
    }
    if (system_.update_map(*out_)) system_.hand_over();
  }

  std::vector<StageCosts> finish() { return std::move(stages_); }

 private:
  SystemUnderTest system_;
  StageProbe probe_;
  std::unique_ptr<RegisteredScan> out_;
  std::vector<StageCosts> stages_;
};

}  // namespace

evaluation::StampedPose stamped(std::int64_t stamp_ns, const Eigen::Isometry3d& T_map_base) {
  return {stamp_ns, T_map_base.translation(), Eigen::Quaterniond(T_map_base.linear()).normalized()};
}

Pass measure_pass(DataSet& data, bool look_at_memory) {
  MeasuringSink sink(data.settings(), look_at_memory);
  data.play(sink);
  return sink.finish();
}

std::vector<StageCosts> measure_stages(DataSet& data) {
  SplittingSink sink(data.settings());
  data.play(sink);
  return sink.finish();
}

}  // namespace isobar::bench
