// SPDX-License-Identifier: BSD-3-Clause
// Two builds on the same data: ratios of results that were made in turns.
#pragma once

#include <string>
#include <vector>

#include "tests/benchmark/driver/result.hpp"

namespace isobar::bench {

/// A JSON file. Throws DataError.
Json read_json(const std::string& file);

/// `a` and `b`: files that `isobar_benchmark run` wrote, equally many; the i-th of both were made one after
/// the other, so that what disturbed the machine disturbed both. For every data set and figure the median of
/// the ratios b / a of these pairs, with the smallest and the largest. Throws DataError where they do not
/// belong together, UsageError where their numbers differ.
Json compare_results(const std::vector<std::string>& a, const std::vector<std::string>& b);

void print_comparison(const Json& ratios);

}  // namespace isobar::bench
