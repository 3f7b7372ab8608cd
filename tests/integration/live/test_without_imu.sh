#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard of a robot without an IMU: poses from lidar and wheels, and from the lidar alone; a silent IMU is another thing.
# Usage: test_without_imu.sh ISOBAR ISOBARD   (through tests/ipc/isolated)
set -euo pipefail
isobar=$1 isobard=$2

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 30 "$log"; done; exit 1; }
ok() { echo "ok: $*"; }

# run NAME SIMULATE_OPTION...   plays a drive without these sensors; figures in NAME.json
run() {
  local name=$1
  shift
  "$isobar" simulate stairs-demo --seed 5 --short --stop-after 14 "$@" --out "$work/$name-recording" \
    >"$work/$name-simulate.log" 2>&1
  [ -e "$work/$name.toml" ] || "$isobar" config show --sensors-of "$work/$name-recording" >"$work/$name.toml"
  "$isobard" --config "$work/$name.toml" --output "$work/$name" >"$work/$name.log" 2>&1 &
  local daemon=$!
  pids+=("$daemon")
  for _ in $(seq 100); do grep -q 'ready:' "$work/$name.log" && break; sleep 0.1; done
  "$isobar" play "$work/$name-recording" --reference-out "$work/$name-played" >"$work/$name-play.log" 2>&1 || fail "play"
  sleep 0.5
  kill -TERM "$daemon"
  wait "$daemon" || fail "$name: isobard did not stop with code 0"
}

# registered NAME LEAST LARGEST_M   poses near the truth
registered() {
  local poses largest
  poses=$(grep -c ',registered,6dof,' "$work/$1/status.csv") || true
  [ "$poses" -ge "$2" ] || fail "$1: only $poses registered poses"
  "$isobar" evaluate "$work/$1-played/reference.tum" "$work/$1" --json "$work/$1.json" >"$work/$1-evaluate.log"
  largest=$(grep -o '"ate_max_m": *[-0-9.e]*' "$work/$1.json" | sed 's/.*: *//')
  awk -v e="$largest" -v m="$3" 'BEGIN { exit !(e < m) }' || fail "$1: position off by $largest m"
  [ -s "$work/$1/map.ply" ] || [ -n "$(ls "$work/$1/map" 2>/dev/null)" ] || fail "$1: no map"
  ok "$1: $poses poses registered, at most $largest m off"
}

run wheels --without imu
grep -q '^imu.source = "none"' "$work/wheels.toml" || fail "config show --sensors-of: imu.source is not none"
registered wheels 90 0.15
[ "$(grep -c 'no IMU: every scan as 6-DOF' "$work/wheels.log")" -eq 1 ] || fail "what it costs is not said once"
grep -Eq '(error|warning): (imu|attitude)' "$work/wheels.log" && fail "an IMU that is configured away is missed"
ok "an IMU that is configured away is said once, and not missed"

run alone --without imu --without wheels --without barometer --without base
registered alone 90 0.3

# The same robot, but an IMU is configured.
sed 's/^imu.source = .*/imu.source = "datagram"/' "$work/wheels.toml" >"$work/silent.toml"
run silent --without imu
grep -q 'imu: nothing received yet' "$work/silent.log" || fail "a configured IMU that is silent is not missed"
ok "an IMU that is configured and silent is missed"
