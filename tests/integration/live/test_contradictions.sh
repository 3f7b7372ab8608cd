#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard of a robot whose IMU contradicts it: said once, in seconds, and the run goes on in a new map frame without it.
# Usage: test_contradictions.sh ISOBAR ISOBARD   (through tests/ipc/isolated)
set -euo pipefail
isobar=$1 isobard=$2

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 30 "$log"; done; exit 1; }
ok() { echo "ok: $*"; }

"$isobar" simulate stairs-demo --seed 3 --stop-after 18 --out "$work/drive" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/drive" >"$work/drive.toml"

# run NAME AWK   plays the drive with changed columns of imu.csv: t, gyro x y z, acceleration x y z
run() {
  local name=$1
  cp -r "$work/drive" "$work/$name-recording"
  awk -F, -v OFS=, "NR > 1 { $2 } { print }" "$work/drive/imu.csv" >"$work/$name-recording/imu.csv"
  "$isobard" --config "$work/drive.toml" --output "$work/$name" >"$work/$name.log" 2>&1 &
  local daemon=$!
  pids+=("$daemon")
  for _ in $(seq 100); do grep -q 'ready:' "$work/$name.log" && break; sleep 0.1; done
  "$isobar" play "$work/$name-recording" >"$work/$name-play.log" 2>&1 || fail "play"
  sleep 0.5
  kill -TERM "$daemon"
  wait "$daemon" || fail "$name: isobard did not stop with code 0"
}

# left_out NAME SENTENCE LEAST_POSES
left_out() {
  [ "$(grep -c "imu/contradiction: $2" "$work/$1.log")" -eq 1 ] || fail "$1: not said once"
  grep -q 'input/left_out: not used: IMU' "$work/$1.log" || fail "$1: what is left out is not said"
  grep -q "contradiction,1,.*$2" "$work/$1/counters.csv" || fail "$1: not in counters.csv"
  local poses
  poses=$(grep -c ',registered,6dof,' "$work/$1/status_2.csv") || true
  [ "$poses" -ge "$3" ] || fail "$1: only $poses poses registered without the IMU, in a frame of its own"
  ok "$1: said once; $poses poses without the IMU"
}

run down '$3 = -$3; $4 = -$4; $6 = -$6; $7 = -$7'
left_out down 'gravity points up: imu.rpy_deg = \[180, 0, 0\] would fit' 80

run degrees '$2 *= 57.29578; $3 *= 57.29578; $4 *= 57.29578'
left_out degrees 'the gyro turns 5[0-9] times as fast as the [a-z]*: is it in deg/s' 20

run right ''
grep -Eq 'contradiction|left_out' "$work/right.log" && fail "a drive without faults contradicts itself"
[ -e "$work/right/status_2.csv" ] && fail "a drive without faults begins a new map frame"
ok "a drive without faults contradicts nothing"
