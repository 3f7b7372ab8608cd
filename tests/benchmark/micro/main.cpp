// SPDX-License-Identifier: BSD-3-Clause
// isobar_micro_benchmark: cost of single operations. Run it through tests/ipc/isolated, because it starts its
// own isobard.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
