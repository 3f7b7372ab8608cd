#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard with encoders on a GPIO chip that is missing, and on a file that is none: said, tried again, and wheels
# that come as datagrams are refused meanwhile.
# Usage: test_wheels_live.sh ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
isobard=$1

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; tail -n 30 "$work"/*.log; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
wait_for() { # WORDS: at most 20 s
  for _ in $(seq 200); do grep -q -- "$1" "$work/isobard.log" && { ok "said: $1"; return 0; }; sleep 0.1; done
  fail "\"$1\" did not come"
}

cat >"$work/isobard.toml" <<TOML
[wheel]
source = "encoder"
[wheel.encoder]
chip = "$work/gpiochip0"
left_a = 17
left_b = 18
right_a = 22
right_b = 23
[input]
port = 17373
[lidar]
port = 12368
TOML
"$isobard" --config "$work/isobard.toml" --output "$work/out" >"$work/isobard.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:'
wait_for "error: wheels: encoders on $work/gpiochip0: the lines cannot be requested (No such file or directory)"
printf 'wheel,%d,0,1,0,0\n' 1 2 3 >/dev/udp/127.0.0.1/17373
wait_for 'warning: wheels/refused: wheel lines refused: wheel.source is not datagram'
touch "$work/gpiochip0"
wait_for "warning: encoders on $work/gpiochip0: the lines cannot be requested (Inappropriate ioctl for device)"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
grep -q '^wheel edges lost,0' "$work/out/counters.csv" || fail "no count of lost edges in counters.csv"
grep -q '^wheel samples,0' "$work/out/counters.csv" || fail "samples of a chip that is missing"
sed -i '/^left_b/d' "$work/isobard.toml"
if "$isobard" --config "$work/isobard.toml" >"$work/isobard.log" 2>&1; then fail "an encoder with one line started"; fi
wait_for 'wheel.encoder.left_b: must name a line: each side needs an encoder with two lines'
echo "$checks checks"
