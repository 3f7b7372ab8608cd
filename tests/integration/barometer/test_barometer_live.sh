#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard with barometers attached to this machine: an IIO device of the kernel, imitated by a folder, and a
# missing DPS310.
# Usage: test_barometer_live.sh ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
isobard=$1

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; tail -n 30 "$work"/*.log; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
wait_for() { # WORDS FILE: at most 20 s
  for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && { ok "said: $1"; return 0; }; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}
stop() {
  kill -TERM "$1"
  wait "$1" || fail "isobard did not stop with code 0"
}

device=$work/iio:device0
mkdir "$device"
echo 21400 >"$device/in_temp_input"
# Writes a new pressure about twenty times a second while the file "run" exists; without truncation (1<>), so
# that no read meets an empty file.
feed() {
  local n=0
  while [ -e "$work/run" ]; do
    n=$((n + 1))
    printf '100.%03d\n' $((500 + n % 50)) >"$device/next"
    cat "$device/next" 1<>"$device/in_pressure_input"
    sleep 0.05
  done
}
touch "$work/run"
printf '100.500\n' >"$device/in_pressure_input"
feed &
pids+=("$!")

cat >"$work/iio.toml" <<TOML
[barometer]
source = "iio"
[barometer.iio]
folder = "$device"
[input]
address = "127.0.0.1"
port = 17373
[lidar]
port = 12368
TOML
"$isobard" --config "$work/iio.toml" --output "$work/iio" >"$work/iio.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/iio.log"
wait_for "info: barometer: .* per second from barometer $device" "$work/iio.log"
printf 'baro,%d,0,99000,20\n' 1 2 3 >/dev/udp/127.0.0.1/17373
wait_for 'warning: barometer/refused: baro lines refused: barometer.source is not datagram' "$work/iio.log"
rm "$work/run" # the value freezes
wait_for "error: barometer: barometer $device: the value no longer changes" "$work/iio.log"
stop "$daemon"
grep -q '^baro lines refused,3' "$work/iio/counters.csv" || fail "the refused lines are not in counters.csv: $(grep refused "$work/iio/counters.csv")"
grep -q '^shared memory faults,0' "$work/iio/counters.csv" || fail "counters.csv does not count the faults of shared memory"
readings=$(grep '^barometer readings,' "$work/iio/counters.csv" | cut -d, -f2)
[ "$readings" -ge 10 ] || fail "only $readings readings"
ok "$readings readings, 3 datagrams refused"

cat >"$work/dps310.toml" <<TOML
[barometer]
source = "dps310"
[barometer.dps310]
bus = "/dev/i2c-that-is-not-there"
[input]
port = 17373
[lidar]
port = 12368
TOML
"$isobard" --config "$work/dps310.toml" >"$work/dps310.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'error: barometer: DPS310 on /dev/i2c-that-is-not-there at 0x77: the bus cannot be opened (No such file or directory)' "$work/dps310.log"
sleep 1
kill -0 "$daemon" || fail "isobard ended because a sensor is missing"
stop "$daemon"
ok "isobard lives on without its barometer"
echo "$checks checks"
