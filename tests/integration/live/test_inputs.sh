#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Inputs of isobard on a hostile network: an address that comes late and goes, a second lidar, forged samples.
# Usage: test_inputs.sh ISOBAR ISOBARD   (through tests/ipc/isolated: root, a network of its own)
set -euo pipefail
isobar=$1 isobard=$2
rival=$(dirname "$0")/rival.py
relay=$(dirname "$0")/unsteady_relay.py
if [ "${ISOBAR_ISOLATED:-}" != yes ]; then echo "skipped: needs a network namespace of its own"; exit 0; fi

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 30 "$log"; done; exit 1; }
ok() { echo "ok: $*"; }
wait_for() { # WORDS FILE SECONDS
  for _ in $(seq $(($3 * 10))); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2 within $3 s"
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 12 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/all.toml"
sed -e 's/^lidar.address = .*/lidar.address = "203.0.113.7"/; s/^input.address = .*/input.address = "203.0.113.7"/' \
  "$work/all.toml" >"$work/late.toml"

# 1. The address comes 2 s after the start.
"$isobard" --config "$work/late.toml" --output "$work/late" >"$work/late.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/late.log" 10
wait_for '203.0.113.7:2368: no network interface of this machine has that address' "$work/late.log" 5
sleep 1
kill -0 "$daemon" || fail "isobard ended while its address was not there"
ip address add 203.0.113.7/32 dev lo
wait_for 'no longer: UDP 203.0.113.7:7373' "$work/late.log" 5
"$isobar" play "$work/recording" --address 203.0.113.7 >"$work/play.log" 2>&1 &
play=$!
pids+=("$play")
sleep 5
ip address del 203.0.113.7/32 dev lo # the cable is pulled for 2 s
sleep 2
ip address add 203.0.113.7/32 dev lo
wait "$play" || true # `play` cannot send without the address, and may end
sleep 1
"$isobar" play "$work/recording" --address 203.0.113.7 --reference-out "$work/played" >"$work/play.log" 2>&1 || true
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
lines=$(grep -c 'no network interface of this machine' "$work/late.log")
[ "$lines" -le 8 ] || fail "$lines lines about the missing address"
poses=$(cat "$work"/late/trajectory*.tum | grep -vc "^#") # a new map frame may have a file of its own
[ "$poses" -ge 60 ] || fail "only $poses poses after the address came"
starts=$(grep -c 'input/starts_over: the lidar' "$work/late.log")
[ "$starts" -eq 1 ] || fail "the second recording counted as $starts starts of the input instead of one"
ok "a second recording is noticed as such, a pulled cable is none"
ok "an address that came late and went for 2 s: $poses poses, $lines lines about it"

# 2. From 127.0.0.2 a second lidar and forged samples; every interface listens, as in a careless configuration.
sed -e 's/^input.address = .*/input.address = "0.0.0.0"/' "$work/all.toml" >"$work/open.toml"
"$isobard" --config "$work/open.toml" --output "$work/rival" >"$work/rival.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/rival.log" 10
"$isobar" play "$work/recording" --reference-out "$work/played" >"$work/play.log" 2>&1 &
play=$!
pids+=("$play")
sleep 1.5
python3 "$rival" "$work/recording/lidar.pcap" 12 127.0.0.1 >"$work/forger.log" 2>&1 &
forger=$!
pids+=("$!")
wait "$play" || fail "play"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
for words in 'lidar/senders: 127.0.0.1 is used, 127.0.0.2 sends, too' 'imu/senders: 127.0.0.1 is used' \
  'barometer/senders: 127.0.0.1 is used' 'wheels/senders: 127.0.0.1 is used'; do
  grep -q "$words" "$work/rival.log" || fail "no \"$words\" in the log"
done
refused=$(sed -n 's/^lidar packets of another sender,\([0-9]*\).*/\1/p' "$work/rival/counters.csv")
[ "$refused" -ge 2000 ] || fail "only $refused packets of the second lidar were refused"
"$isobar" evaluate "$work/played/reference.tum" "$work/rival" --json "$work/figures.json" >"$work/evaluate.log"
largest=$(grep -o '"ate_max_m": *[-0-9.e]*' "$work/figures.json" | sed 's/.*: *//')
awk -v e="$largest" 'BEGIN { exit !(e < 0.3) }' || fail "position off by $largest m beside a rival"
ok "a rival's lidar and samples: $refused packets refused, position within 30 cm (largest error $largest m)"

# 3. By default samples come from this machine only.
"$isobard" --config "$work/all.toml" >"$work/default.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/default.log" 10
ss -lun | grep -q '127.0.0.1:7373' || fail "samples are not received on loopback only: $(ss -lun)"
kill -TERM "$daemon"
wait "$daemon"
ok "by default samples are received on loopback only"

# 4. The network loses everything for 5 s: the sensors have gone on, so does the map frame. Without the rival.
wait "$forger" || true
"$isobard" --config "$work/all.toml" --output "$work/lost" >"$work/lost.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/lost.log" 10
python3 "$relay" lost 4 5 >"$work/relay.log" 2>&1 &
pids+=("$!")
sleep 0.5
"$isobar" play "$work/recording" --lidar-port 12368 --input-port 17373 >"$work/play.log" 2>&1 || fail "play"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
grep -q 'input/starts_over' "$work/lost.log" && fail "5 s without packets are held for another recording"
[ ! -e "$work/lost/trajectory_2.tum" ] || fail "5 s without packets began a new map frame"
after=$(awk '!/^#/ && n && $1 - last > 4 { n = 0; gap = 1 } !/^#/ { last = $1; n++ } END { print gap ? n : 0 }' "$work/lost/trajectory.tum")
[ "$after" -ge 10 ] || fail "only $after poses after 5 s without packets"
ok "5 s without packets: $after poses after them in the same map frame"
