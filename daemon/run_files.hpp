// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "config/config.hpp"
#include "daemon/health.hpp"
#include "run/files/run_output.hpp"
#include "run/tile_store/file_tile_store.hpp"

namespace isobar {

/// Files of a live run: the run folder of [output] and the tile store of the map, each only if configured.
/// Main thread only; output() and store() belong to the output thread and the map thread while these run.
class RunFiles {
 public:
  /// Creates the folders and writes the settings of the run.
  /// @throws ServiceError when the disk refuses
  explicit RunFiles(const Config& config);

  [[nodiscard]] files::RunOutput* output() noexcept {
    return output_ ? &*output_ : nullptr;
  }                                                                       ///< null: none configured
  [[nodiscard]] FileTileStore* store() noexcept { return store_.get(); }  ///< null: none configured

  /// Writes map.ply and counters.csv. Call once, after all threads have stopped.
  /// @throws ServiceError when the disk refuses
  void close(const StatusSnapshot& last);

 private:
  std::optional<files::RunOutput> output_;
  std::unique_ptr<FileTileStore> store_;
  std::filesystem::path directory_;
};

}  // namespace isobar
