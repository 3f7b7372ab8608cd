#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `isobar export --mcap` of a run, opened and decoded by Foxglove's own libraries; a file that cannot be written.
# Usage: test_export.sh ISOBAR NODE READER     exit code 77: Foxglove's libraries are not installed
set -euo pipefail
isobar=$1 node=$2 reader=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

"$isobar" simulate corridor --seed 3 --short --stop-after 8 --out "$work/recording" >"$work/log" 2>&1
"$isobar" replay "$work/recording" --out "$work/run" >"$work/log" 2>&1 || fail "replay: $(cat "$work/log")"
"$isobar" export "$work/run/" --mcap --recording "$work/recording" >"$work/export.log"
grep -q "written: $work/run.mcap: " "$work/export.log" || fail "$(cat "$work/export.log")"
code=0
"$node" "$reader" "$work/run.mcap" "$work/run" >"$work/read.log" || code=$?
[ "$code" -eq 77 ] && exit 77
[ "$code" -eq 0 ] || fail "$(cut -c 1-2000 "$work/read.log")"
for topic in /pose /tf /tf_static /path /altitude /map_cloud /scan_time /imu/data /fluid_pressure /base/fluid_pressure /wheel/twist; do
  grep -q "\"$topic\":" "$work/read.log" || fail "no $topic in $(cut -c 1-2000 "$work/read.log")"
done

# What cannot be exported leaves the file of before.
cp "$work/run.mcap" "$work/before.mcap"
rm "$work/run/trajectory.tum"
code=0
"$isobar" export "$work/run" --mcap 2>"$work/error.log" || code=$?
[ "$code" -eq 65 ] && grep -q trajectory.tum "$work/error.log" || fail "code $code: $(cat "$work/error.log")"
cmp "$work/run.mcap" "$work/before.mcap" || fail "a failed export changed the file"
[ "$(find "$work" -maxdepth 1 -name '*.part' | wc -l)" -eq 0 ] || fail "a part is left behind"
echo "ok: an exported run, read back by Foxglove's libraries"
