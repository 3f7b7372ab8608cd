#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The reports of a short run, with and without a reference, and of its barometer's noise, in Chromium.
# Usage: test_reports.sh ISOBAR NODE     exit code 77: Chromium or npm's packages are missing
set -euo pipefail
isobar=$1 node=$2
here=$(cd "$(dirname "$0")" && pwd)
[ -d "$here/npm/node_modules/puppeteer-core" ] && [ -x /usr/bin/chromium ] || { echo "skipped: npm ci in $here/npm, chromium"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$isobar" simulate corridor --seed 3 --short --stop-after 20 --out "$work/recording" >"$work/log" 2>&1
for method in 4dof adaptive; do
  "$isobar" replay "$work/recording" --out "$work/$method" --method "$method" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
done
"$isobar" evaluate "$work/recording" "$work/adaptive" "$work/4dof" --report "$work/evaluation.html" >"$work/log"
"$isobar" report "$work/adaptive" --out "$work/run.html" >"$work/log"
"$isobar" noise "$work/recording/barometer.csv" --report "$work/noise.html" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$node" "$here/report.mjs" "$work/evaluation.html" "$work/run.html" "$work/noise.html"
