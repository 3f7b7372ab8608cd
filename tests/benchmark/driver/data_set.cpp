// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/data_set.hpp"

#include <cmath>
#include <cstdio>

#include "run/recording/manifest.hpp"
#include "simulation/simulate.hpp"

namespace isobar::bench {

namespace {

/// Folder of the scenario's recording, simulated if missing. A shortened run has its own folder.
std::filesystem::path simulated(const std::string& scenario, const DataSetOptions& options) {
  std::string name = scenario + "-" + std::to_string(options.seed);
  if (std::isfinite(options.stop_after_s))
    name += "-" + std::to_string(std::lround(options.stop_after_s)) + "s";
  const std::filesystem::path folder = options.cache / name;
  if (std::filesystem::exists(folder)) return folder;
  std::fprintf(stderr, "simulating %s\n", name.c_str());
  // Renamed once complete: an interrupted run leaves no partial recording under the final name.
  const std::filesystem::path unfinished = options.cache / (name + ".unfinished");
  std::filesystem::remove_all(unfinished);
  std::filesystem::create_directories(options.cache);
  simulation::ScenarioRequest request;
  request.name = scenario;
  request.seed = options.seed;
  request.stop_after_s = options.stop_after_s;
  simulation::simulate(request, unfinished, {});
  std::filesystem::rename(unfinished, folder);
  return folder;
}

}  // namespace

std::unique_ptr<DataSet> open_data_set(const std::string& what, const DataSetOptions& options) {
  std::filesystem::path path = std::filesystem::path(what).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();  // "folder/"
  if (std::filesystem::is_directory(path)) {
    return std::filesystem::exists(path / recording::kManifestFile) ? open_recording(path, options)
                                                                    : open_clouds(path, options);
  }
  return open_recording(simulated(what, options), options);
}

}  // namespace isobar::bench
