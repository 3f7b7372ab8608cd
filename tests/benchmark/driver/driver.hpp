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
  bool with_stages = true;        ///< one more pass that splits registrations by stage
  bool with_peers = true;         ///< one more pass side by side with the peers
  std::size_t peer_scans = 1200;  ///< of that pass, at most: the peers are slow
};

/// Measures on every data set. {machine, data: [{name, ms, growth, memory, …, peers}]}. Throws DataError,
/// UsageError.
nlohmann::ordered_json run_benchmark(const DriverOptions& options);

}  // namespace isobar::bench
