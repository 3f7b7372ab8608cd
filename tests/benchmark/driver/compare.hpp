// SPDX-License-Identifier: BSD-3-Clause
// Comparison of two builds on the same data: ratios of results of alternating runs.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmark/driver/result.hpp"

namespace isobar::bench {

/// Reads a JSON file.
/// @throws DataError when the file cannot be read or is not JSON
Json read_json(const std::string& file);

/// Compares results of `isobar_benchmark run`: per data set and figure the median, smallest and largest ratio
/// b / a over the pairs. `a`, `b`: equally many files; the i-th of both come from successive runs, so that
/// disturbances of the machine affect both.
/// @throws DataError when the files are of different data or not results of a run
/// @throws UsageError when the numbers of files differ
Json compare_results(const std::vector<std::string>& a, const std::vector<std::string>& b);

void print_comparison(const Json& ratios);

}  // namespace isobar::bench
