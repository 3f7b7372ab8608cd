#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs that are killed every two seconds, on stairs, on a rope and in an elevator, in lock step: each continues within
# 3 s, in its frame, at the right place (bench_restart fails otherwise).
# Usage: test_restarts.sh ISOBAR BENCH_RESTART
set -euo pipefail
isobar=$1 bench=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for scenario in stairs-demo moulin elevator; do
  "$isobar" simulate "$scenario" --seed 2 --short --out "$work/$scenario" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
  echo "$scenario"
  TMPDIR=$work "$bench" "$work/$scenario" 2 0.6
done
