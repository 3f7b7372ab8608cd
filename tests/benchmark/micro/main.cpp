// SPDX-License-Identifier: BSD-3-Clause
// isobar_micro_benchmark: single operations. Run it through tests/ipc/isolated: it starts its own isobard.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
