#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard with a VN-100 on a pseudo-terminal, which is also the robot's barometer: started, unplugged, back.
# Usage: test_imu_live.sh ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
isobard=$1

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; tail -n 30 "$work"/*.log; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
now_ms() { date +%s%3N; }
wait_for() { # WORDS COUNT: until the log has them COUNT times, at most 10 s; sets `took` [ms]
  local begin
  begin=$(now_ms)
  until [ "$(grep -c -- "$1" "$work/isobard.log")" -ge "$2" ]; do
    [ $(($(now_ms) - begin)) -lt 10000 ] || fail "\"$1\" did not come $2 times"
    sleep 0.01
  done
  took=$(($(now_ms) - begin))
  ok "said after $took ms: $1"
}

python3 "$(dirname "$0")/vn100.py" "$work/imu" "$work/stop" 2>"$work/vn100.log" &
pids+=("$!")
cat >"$work/isobard.toml" <<TOML
[imu]
source = "vn100"
rpy_deg = [180.0, 0.0, 0.0] # a VN-100 with its label up
[imu.vn100]
port = "$work/imu"
[barometer]
source = "imu"
[input]
port = 17373
[lidar]
port = 12368
TOML
"$isobard" --config "$work/isobard.toml" --output "$work/out" >"$work/isobard.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' 1
wait_for "info: imu: .* per second from VN-100 on $work/imu" 1
wait_for 'info: barometer: .* per second' 1
printf 'imu,%d,0,0,0,0,0,0,9.81\n' 1 2 3 >/dev/udp/127.0.0.1/17373
wait_for 'warning: imu/refused: imu lines refused: imu.source is not datagram' 1
touch "$work/stop"
wait_for "error: imu: VN-100 on $work/imu: unplugged" 1
# 0.2 s, and what the two scripts need to notice.
[ "$took" -lt 350 ] || fail "unplugged was said after $took ms"
sleep 1
rm "$work/stop"
wait_for "info: imu: .* per second from VN-100 on $work/imu" 2
[ "$took" -lt 2100 ] || fail "back after $took ms"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
readings=$(grep '^imu samples,' "$work/out/counters.csv" | cut -d, -f2)
pressures=$(grep '^barometer samples,' "$work/out/counters.csv" | cut -d, -f2)
echo "$readings samples, $pressures pressures"
echo "$checks checks"
