// SPDX-License-Identifier: BSD-3-Clause
// Data sets of the benchmark: recordings, simulated scenarios, folders of point clouds.
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

/// Receives priors and scans of a data set, in the order of the registration stage.
class ScanSink {
 public:
  virtual ~ScanSink() = default;
  virtual void on_prior(const Prior& prior) = 0;
  /// A scan, once priors reach its end; `decode_ms`: CPU time of decoding its packets.
  virtual void on_scan(const Scan& scan, double decode_ms) = 0;
  /// True to end the pass.
  [[nodiscard]] virtual bool done() const { return false; }
};

/// Sequence of scans with priors; every pass gives the same.
class DataSet {
 public:
  virtual ~DataSet() = default;
  virtual void play(ScanSink& sink) = 0;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const StageSettings& settings() const { return settings_; }
  /// Reference path; empty if unknown.
  [[nodiscard]] const evaluation::Trajectory& reference() const { return reference_; }

 protected:
  std::string name_;
  StageSettings settings_;
  evaluation::Trajectory reference_;
};

struct DataSetOptions {
  std::uint64_t seed = 1;  ///< random seed of scenarios
  double stop_after_s = std::numeric_limits<double>::infinity();
  std::filesystem::path cache = "build/benchmark/data";  ///< folder of the scenarios' recordings
  Config config;                                         ///< sensors and mounts come from the recording
};

/// Opens a data set. `what`: a folder with recording.toml, a folder with *.pcd or *.bin, else the name of a
/// scenario, which is simulated once and kept.
/// @throws DataError when files break their format
/// @throws UsageError when there is no such scenario
std::unique_ptr<DataSet> open_data_set(const std::string& what, const DataSetOptions& options);

std::unique_ptr<DataSet> open_recording(const std::filesystem::path& folder, const DataSetOptions& options);
std::unique_ptr<DataSet> open_clouds(const std::filesystem::path& folder, const DataSetOptions& options);

}  // namespace isobar::bench
