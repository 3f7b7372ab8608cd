#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The reports of a short run, with and without a reference, and of its barometer's noise, and its page, in Chromium.
# Usage: test_reports.sh ISOBAR NODE     (through tests/ipc/isolated, where root) exit code 77: Chromium or npm's packages are missing
set -euo pipefail
isobar=$1 node=$2
here=$(cd "$(dirname "$0")" && pwd)
[ -d "$here/npm/node_modules/puppeteer-core" ] && [ -d "$here/npm/node_modules/axe-core" ] && [ -x /usr/bin/chromium ] || { echo "skipped: npm ci in $here/npm, chromium"; exit 77; }
work=$(mktemp -d)
web=
trap '[ -z "$web" ] || kill "$web"; rm -rf "$work"' EXIT
"$isobar" simulate corridor --seed 3 --short --stop-after 20 --out "$work/recording" >"$work/log" 2>&1
for method in 4dof adaptive; do
  "$isobar" replay "$work/recording" --out "$work/$method" --method "$method" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
done
"$isobar" evaluate "$work/recording" "$work/adaptive" "$work/4dof" --report "$work/evaluation.html" >"$work/log"
"$isobar" report "$work/adaptive" --out "$work/run.html" >"$work/log"
"$isobar" noise "$work/recording/barometer.csv" --report "$work/noise.html" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$isobar" web "$work/adaptive" --port 18081 >"$work/web.log" 2>&1 &
web=$!
for _ in $(seq 100); do grep -q http "$work/web.log" && break; sleep 0.1; done
"$node" "$here/report.mjs" "$work/evaluation.html" "$work/run.html" "$work/noise.html" http://localhost:18081/ || { cat "$work/web.log"; exit 1; }
