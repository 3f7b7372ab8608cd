// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/driver/driver.hpp"

#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "tests/benchmark/driver/passes.hpp"
#include "tests/benchmark/driver/peer_pass.hpp"
#include "tests/benchmark/driver/result.hpp"

namespace isobar::bench {

namespace {

Json peers_json(DataSet& data, std::size_t scans) {
  PeerSettings settings;
  settings.first_distance_m = data.settings().registration.first_distance_m;
  settings.last_distance_m = data.settings().registration.last_distance_m;
  settings.max_iterations = data.settings().registration.max_iterations;
  settings.convergence_m = data.settings().registration.convergence_m;
  settings.map_radius_m = data.settings().map.radius_m;
  auto peers = make_peers(settings);
  if (peers.empty()) return peers_refusal();
  return peer_figures(data, measure_peers(data, std::move(peers), scans));
}

Json run_on(DataSet& data, const DriverOptions& options) {
  std::vector<Pass> passes;
  for (int i = 0; i < options.repeat; ++i) {
    passes.push_back(measure_pass(data, i == 0));
    if (passes.back().scans.empty()) throw DataError(data.name() + ": contains no decodable scan");
  }
  Json result =
      own_figures(data, passes, options.with_stages ? measure_stages(data) : std::vector<StageCosts>{});
  if (options.with_peers) result["peers"] = peers_json(data, options.peer_scans);
  return result;
}

}  // namespace

Json run_benchmark(const DriverOptions& options) {
  Json result{{"machine", machine_json()}, {"data", Json::array()}};
  for (const std::string& what : options.data) {
    const auto data = open_data_set(what, options.data_options);
    result["data"].push_back(run_on(*data, options));
  }
  return result;
}

}  // namespace isobar::bench
