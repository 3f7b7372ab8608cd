// SPDX-License-Identifier: BSD-3-Clause
// What the benchmark runs on: a recording, a scenario that becomes one, or a folder of point clouds.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "config/config.hpp"
#include "core/estimates.hpp"
#include "core/samples.hpp"
#include "daemon/lock_step.hpp"
#include "run/evaluation/trajectory.hpp"

namespace isobar::bench {

/// Takes what a data set gives, in the order in which registration would see it.
class ScanSink {
 public:
  virtual ~ScanSink() = default;
  virtual void on_prior(const Prior& prior) = 0;
  /// A scan whose end the priors have reached; `decode_ms`: CPU time from its packets to it.
  virtual void on_scan(const Scan& scan, double decode_ms) = 0;
  /// True where it needs no more.
  [[nodiscard]] virtual bool done() const { return false; }
};

/// A sequence of scans with priors that can be played any number of times, always the same.
class DataSet {
 public:
  virtual ~DataSet() = default;
  virtual void play(ScanSink& sink) = 0;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const StageSettings& settings() const { return settings_; }
  /// Empty: nobody knows the path.
  [[nodiscard]] const evaluation::Trajectory& reference() const { return reference_; }

 protected:
  std::string name_;
  StageSettings settings_;
  evaluation::Trajectory reference_;
};

struct DataSetOptions {
  std::uint64_t seed = 1;  ///< of scenarios
  double stop_after_s = std::numeric_limits<double>::infinity();
  std::filesystem::path cache = "build/benchmark/data";  ///< where recordings of scenarios are kept
  Config config;                                         ///< sensors and mounts come from the recording
};

/// `what`: a folder with recording.toml, a folder with *.pcd or *.bin, else the name of a scenario, which is
/// simulated once and kept. Throws DataError, UsageError.
std::unique_ptr<DataSet> open_data_set(const std::string& what, const DataSetOptions& options);

std::unique_ptr<DataSet> open_recording(const std::filesystem::path& folder, const DataSetOptions& options);
std::unique_ptr<DataSet> open_clouds(const std::filesystem::path& folder, const DataSetOptions& options);

}  // namespace isobar::bench
