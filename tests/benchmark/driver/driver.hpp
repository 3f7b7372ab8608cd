// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tests/benchmark/driver/data_set.hpp"

namespace isobar::bench {

struct DriverOptions {
  std::vector<std::string> data;  ///< see open_data_set()
  DataSetOptions data_options;
  int repeat = 3;                 ///< passes over each data set, >= 1
  bool with_stages = true;        ///< additional pass: time of each stage of the registration
  bool with_peers = true;         ///< additional pass with the peers
  std::size_t peer_scans = 1200;  ///< at most, in that pass: the peers are slow
};

/// Measures on every data set. Returns {machine, data: [{name, ms, growth, memory, …, peers}]}.
/// @throws DataError when a data set cannot be read
/// @throws UsageError when there is no such scenario
nlohmann::ordered_json run_benchmark(const DriverOptions& options);

}  // namespace isobar::bench
