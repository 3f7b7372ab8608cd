// SPDX-License-Identifier: BSD-3-Clause
// From passes to figures. The result of a run is one JSON document; the tables are printed from it.
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

/// Costs by stage, growth, memory, allocations, hardware counts and error of one data set. `passes` (at least
/// one, all over the same scans): of every scan and figure the median over them is taken, so that what
/// another process of the machine did to one of them is not in it.
Json own_figures(const DataSet& data, const std::vector<Pass>& passes, const std::vector<StageCosts>& stages);

/// What each peer needed, and the ratio theirs / ours of every scan.
Json peer_figures(const DataSet& data, const PeerPass& pass);

/// The processor and the kernel that made the figures.
Json machine_json();

/// Prints a result for people.
void print_tables(const Json& result);

}  // namespace isobar::bench
