#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobar status and isobar metrics beside isobard: before, during and after its life.
# Usage: test_status.sh ISOBAR ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
trap '' PIPE # a server that ends while it is asked
isobar=$1 isobard=$2

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
# wait_until COMMAND…: at most 20 s
wait_until() { for _ in $(seq 200); do "$@" && return 0; sleep 0.1; done; fail "did not come true: $*"; }
# status_is CODE WORDS: isobar status ends with that code and its output has those words.
status_is() {
  local got=0
  timeout 20 "$isobar" status >"$work/status.log" 2>&1 || got=$?
  [ "$got" -eq "$1" ] && grep -q -- "$2" "$work/status.log"
}
scrape() {
  exec 3<>/dev/tcp/127.0.0.1/19464 || return 1
  printf 'GET /metrics HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' >&3
  timeout 5 cat <&3 >"$work/metrics.log"
  exec 3>&-
}
metric_is() { scrape 2>/dev/null && grep -q -- "^$1" "$work/metrics.log"; }

printf '[lidar]\nport = 12368\n[input]\nport = 17373\nexpect_base_station = false\n' >"$work/isobar.toml"
status_is 69 "isobard is not running" || fail "status without isobard"
ok "without isobard the exit code is 69"
"$isobar" metrics --listen 127.0.0.1:19464 >"$work/metrics_command.log" 2>&1 &
metrics=$!
pids+=("$metrics")
wait_until metric_is "isobar_up 0"
ok "metrics without isobard: isobar_up 0"

start() {
  "$isobard" --config "$work/isobar.toml" >>"$work/isobard.log" 2>&1 &
  daemon=$!
  pids+=("$daemon")
}
start
wait_until status_is 3 "lidar: nothing received yet on UDP port 12368"
ok "an isobard without data is waiting, exit code 3"
wait_until metric_is 'isobar_sensor_heard{sensor="lidar"} 0'
metric_is "isobar_up 1" || fail "isobar_up is not 1"
ok "metrics follow isobard"

# An IMU of 100 Hz without a clock, and a barometer of 20 Hz whose clock is 3.2 s behind, lying still.
(i=0; while :; do
  i=$((i + 1))
  printf 'imu,%d,0,0,0,0,0,0,9.80665\n' "$i"
  [ $((i % 5)) -eq 0 ] && printf 'baro,%d,%d,10%04d,20\n' $((i / 5)) $(((${EPOCHREALTIME/[.,]/} - 3200000) * 1000)) $((1000 + i % 7))
  sleep 0.008
done >/dev/udp/127.0.0.1/17373) 2>/dev/null &
pids+=("$!")
sensors=$!
wait_until metric_is 'isobar_height_meters{source="single_barometer"}'
rate=$(grep '^isobar_sensor_rate_hertz{sensor="imu"}' "$work/metrics.log" | sed 's/.* //')
awk -v r="$rate" 'BEGIN { exit !(r > 20 && r < 150) }' || fail "IMU rate $rate"
ok "height and rates are there (IMU $rate Hz)"
"$isobar" status --json >"$work/status.json" || true
grep -q '"height":{"source":"single_barometer"' "$work/status.json" || fail "JSON without height"
grep -q '"name":"wheels","level":"ok","message":"none' "$work/status.json" || fail "wheels are not none"
ok "JSON has the height, and wheels are none"
wait_until metric_is 'isobar_sensor_clock_offset_seconds{sensor="barometer"} -3[.][12]'
metric_is 'isobar_sensor_clock_offset_seconds{sensor="imu"}' && fail "an IMU without a clock has an offset"
metric_is 'isobar_sensor_latency_seconds{sensor="imu",quantile="0.99"} [0-9]' || fail "no latency of the IMU"
"$isobar" status --all >"$work/all.log" || true
grep -q 'barometer/timing: offset -3[.][12]' "$work/all.log" || fail "no timing of the barometer"
tr -s ' \n' ' ' <"$work/all.log" | grep -q 'imu/timing: no clock of its own, latency .*, jitter' || fail "no timing of the IMU"
ok "offset, latency and jitter of the sensors are shown"
kill "$sensors"
wait_until status_is 2 "imu: silent for"
grep -q 'height: no IMU sample for' "$work/status.log" || fail "height does not follow the age of its data"
ok "silent sensors are an error, exit code 2, and height is stale"
timeout 4 "$isobar" status --watch --json >"$work/watch.json" || true
[ "$(wc -l <"$work/watch.json")" -ge 2 ] || fail "--watch printed $(wc -l <"$work/watch.json") lines in 4 s"
ok "--watch shows each report"

timeout 15 "$isobar" status --watch >"$work/hung.log" 2>&1 &
watch=$!
pids+=("$watch")
sleep 2
kill -STOP "$daemon"
status_is 2 "isobard runs but does not answer: it hangs or was stopped" || fail "status of a stopped isobard"
"$isobar" reset --timeout 1 >"$work/reset.log" 2>&1 && fail "reset of a stopped isobard"
grep -q "does not answer" "$work/reset.log" || fail "reset does not say that isobard hangs"
wait_until metric_is "isobar_up 0"
metric_is 'isobar_sensor_rate' && fail "old figures in the metrics"
metric_is 'isobar_health_level' && fail "old levels in the metrics"
kill -CONT "$daemon"
wait "$watch" || true
grep -q "^error *isobard sends no health report for" "$work/hung.log" || fail "--watch shows old figures as fresh"
wait_until metric_is "isobar_up 1"
ok "an isobard that hangs is an error, and no figure of then is shown as fresh"

kill -9 "$daemon"
wait_until metric_is "isobar_up 0"
start
wait_until metric_is "isobar_up 1"
ok "metrics follow a restart of isobard"
[ "$(wc -l <"$work/metrics_command.log")" -le 12 ] || fail "metrics printed $(wc -l <"$work/metrics_command.log") lines"
kill -TERM "$metrics"
wait_until eval '! kill -0 $metrics 2>/dev/null'
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
ok "all stop on SIGTERM"
grep -c . "$work/isobard.log" | { read -r lines; [ "$lines" -lt 60 ] || fail "isobard logged $lines lines"; }
echo "$checks checks"
