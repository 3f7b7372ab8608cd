// SPDX-License-Identifier: BSD-3-Clause
// Figures from passes: the JSON document of a run, and tables printed from it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/passes.hpp"
#include "tests/benchmark/driver/peer_pass.hpp"

namespace isobar::bench {

using Json = nlohmann::ordered_json;

/// {count, mean, median, p90, p99, max}; null without values.
Json quantiles_json(std::vector<double> values);

/// Costs by stage, growth, memory, allocations, hardware counts and error of one data set. `passes`: at least
/// one, all over the same scans. Each figure of a scan is the median over the passes, which removes
/// disturbances by other processes.
Json own_figures(const DataSet& data, const std::vector<Pass>& passes, const std::vector<StageCosts>& stages);

/// Cost of each peer, and the ratio theirs / ours per scan.
Json peer_figures(const DataSet& data, const PeerPass& pass);

/// Processor and kernel of the measurement.
Json machine_json();

/// Prints a result as tables.
void print_tables(const Json& result);

}  // namespace isobar::bench
