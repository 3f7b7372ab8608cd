// SPDX-License-Identifier: BSD-3-Clause
// isobar_micro_benchmark: single operations. Run it below tests/ipc/isolated: it starts an isobard of its
// own.
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
