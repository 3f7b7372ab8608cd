#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard as a service, on the UDP packets of a played recording, with isobar-dds and an echo beside it.
# Usage: test_live.sh ISOBAR ISOBARD ISOBAR-DDS   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2 bridge=$3

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
# expect_exit CODE WORDS COMMAND…: the command ends with that code and its output has those words.
expect_exit() {
  local code=$1 words=$2 got=0
  shift 2
  timeout 60 "$@" >"$work/expect.log" 2>&1 || got=$?
  [ "$got" -eq "$code" ] || fail "exit code $got instead of $code: $*"
  grep -qi -- "$words" "$work/expect.log" || fail "no \"$words\" in the message of: $*"
  ok "exit code $code and \"$words\""
}
wait_for() { # WORDS FILE: at most 20 s
  for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 12 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
"$isobar" config check "$work/isobar.toml" >"$work/check.log" || fail "the shown configuration does not check"

mkdir "$work/folder"
printf 'methud = "3dof"\n' >"$work/unknown.toml"
printf 'method = "5dof"\n' >"$work/value.toml"
expect_exit 78 "unknown.toml:1" "$isobard" --config "$work/unknown.toml"
expect_exit 78 "value.toml:1" "$isobard" --config "$work/value.toml"
expect_exit 78 "is a folder" "$isobard" --config "$work/folder"
expect_exit 78 "missing.toml" "$isobard" --config "$work/missing.toml"
expect_exit 64 "nonsense" "$isobard" --nonsense
expect_exit 69 "" "$isobar" echo pose --timeout 2

"$isobard" --config "$work/isobar.toml" --output "$work/run" >"$work/isobard.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/isobard.log"
expect_exit 69 "isobard" "$isobard" --config "$work/isobar.toml"
kill -0 "$daemon" || fail "the second isobard ended the first"

"$bridge" --config "$work/isobar.toml" >"$work/bridge.log" 2>&1 &
bridge_pid=$!
pids+=("$bridge_pid")
"$isobar" echo pose odom altitude diagnostics --rate 1000 --timeout 0 >"$work/echo.txt" 2>"$work/echo.log" &
pids+=("$!")
"$isobar" play "$work/recording" --reference-out "$work/played" >"$work/play.log" 2>&1
sleep 1

# SIGKILL of the bridge: the estimator continues.
kill -9 "$bridge_pid"
kill -0 "$daemon" || fail "isobard ended with the bridge"
ok "isobard lives on without the bridge"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
ok "isobard stops with code 0"

# The map begins after 2.5 s at rest: 90 poses of 120 scans.
poses=$(grep -c . "$work/run/trajectory.tum")
[ "$poses" -ge 80 ] || fail "only $poses poses of 12 s"
ok "$poses poses written"
points=$(head -c 300 "$work/run/map.ply" | grep -a -o 'element vertex [0-9]*' | grep -o '[0-9]*$')
[ "$points" -gt 1000 ] || fail "only $points map points"
ok "$points map points written"
for topic in pose odom altitude diagnostics; do
  grep -q "^[^ ]*$topic" "$work/echo.txt" || fail "echo received no $topic"
done
[ "$(grep -c '^[^ ]*odom' "$work/echo.txt")" -ge 500 ] || fail "odom came $(grep -c '^[^ ]*odom' "$work/echo.txt") times in 12 s, 100 Hz wanted"
ok "pose, odom at its rate, altitude and diagnostics arrived over DDS"
"$isobar" evaluate "$work/played/reference.tum" "$work/run" --json "$work/figures.json" >"$work/evaluate.log"
largest=$(grep -o '"ate_max_m": *[-0-9.e]*' "$work/figures.json" | sed 's/.*: *//')
awk -v e="$largest" 'BEGIN { exit !(e < 0.3) }' || fail "position off by $largest m"
ok "position within 30 cm (largest error $largest m)"

# isobard is stopped for two seconds: poses resume with the first new scan. Poses of the scans in between come
# from the IMU samples left in the queues, hence the tolerance of a metre.
"$isobard" --config "$work/isobar.toml" --output "$work/stopped" >"$work/stopped.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/stopped.log"
"$isobar" play "$work/recording" --reference-out "$work/played" >"$work/play.log" 2>&1 &
play=$!
sleep 5
kill -STOP "$daemon" || fail "isobard has ended by itself"
sleep 2
kill -CONT "$daemon"
wait "$play"
sleep 1
kill -TERM "$daemon" || fail "isobard has ended by itself after it had been stopped"
wait "$daemon" || fail "isobard did not stop with code 0 after it had been stopped"
gaps=$(awk '/^#/ { next } last > 0 && $1 - last > 0.5 { printf "%.2f ", $1 - last } { last = $1 }' "$work/stopped/trajectory.tum")
awk -v g="$gaps" 'BEGIN { n = split(g, gap, " "); exit !(n <= 1 && gap[1] < 2.5) }' || fail "gaps between poses of $gaps s"
ok "one gap between poses around a stop of 2 s (${gaps:-none above 0.5 }s)"
"$isobar" evaluate "$work/played/reference.tum" "$work/stopped" --json "$work/figures.json" >"$work/evaluate.log"
largest=$(grep -o '"ate_max_m": *[-0-9.e]*' "$work/figures.json" | sed 's/.*: *//')
awk -v e="$largest" 'BEGIN { exit !(e < 1.0) }' || fail "position off by $largest m after a stop of 2 s"
ok "position within 1 m after a stop of 2 s (largest error $largest m)"

if [ "${ISOBAR_ISOLATED:-}" = yes ]; then
  mount -o remount,size=32m /dev/shm
  expect_exit 69 "/dev/shm" "$isobard" --config "$work/isobar.toml"
fi
echo "$checks checks"
