#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Floors of a running isobard: the floor, its name and its occupancy grid over DDS, in the status, and by `isobar map`.
# Usage: test_floors.sh ISOBAR ISOBARD ISOBAR-DDS   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2 bridge=$3

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; for log in "$work"/*.log "$work"/echo.txt; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
wait_for() { # WORDS FILE SECONDS
  for _ in $(seq "$(($3 * 10))"); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 9 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
"$isobard" --config "$work/isobar.toml" --output "$work/run" >"$work/isobard.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/isobard.log" 20
"$bridge" --config "$work/isobar.toml" >"$work/bridge.log" 2>&1 &
pids+=("$!")
# Without the usual limit of a line a second, which would leave out a change right after another one.
"$isobar" echo map floor floor_name --rate 1000 --timeout 0 >"$work/echo.txt" 2>"$work/echo.log" &
pids+=("$!")
"$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
play=$!

wait_for '^[^ ]*floor' "$work/echo.txt" 20
wait_for '^[^ ]*map' "$work/echo.txt" 5
ok "a floor and its grid came"
# The name is followed while isobard runs. The tiles of the ground are on the disk 8 s after they were seen.
for _ in $(seq 30); do
  "$isobar" map floors "$work/run" --name "0=Upper hall" >"$work/floors.log" 2>&1 && break
  sleep 0.3
done
grep -q 'Upper hall' "$work/floors.log" || fail "the floor could not be named"
wait_for 'Upper hall' "$work/echo.txt" 5
ok "the name of the floor is followed"
for _ in $(seq 30); do  # a report a second
  "$isobar" status --json >"$work/status.json" 2>"$work/status.log" || true
  grep -q '"floor":{"known":true,"number":0,"name":"Upper hall"' "$work/status.json" && break
  sleep 0.1
done
grep -q '"name":"Upper hall"' "$work/status.json" || fail "the status has no floor: $(grep -o '"floor":[^}]*}' "$work/status.json")"
ok "the status has the floor"
"$isobar" map grid "$work/run" --out "$work/grids" >"$work/grid.log" 2>&1 || fail "no grid of a map that is being written"
[ -s "$work/grids/floor_0.pgm" ] || fail "floor_0.pgm is missing"
ok "a grid of the map that is being written"
kill "$play" 2>/dev/null || true
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
ok "isobard stops with code 0"
echo "$checks checks"
