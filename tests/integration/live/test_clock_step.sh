#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The system clock is set while isobard and isobar-dds run: from 2025 to today, then three days back.
# libfaketime fakes CLOCK_REALTIME of both programs; CLOCK_MONOTONIC runs on, as on a robot whose clock chrony sets.
# Usage: test_clock_step.sh ISOBAR ISOBARD ISOBAR-DDS   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2 bridge=$3
library=$(ls /usr/lib/*/faketime/libfaketimeMT.so.1 2>/dev/null | head -n 1 || true)
if [ -z "$library" ]; then echo "skipped: needs the Debian package faketime"; exit 0; fi

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { echo "ok: $*"; }
wait_for() { # WORDS FILE
  for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}
set_clock() { # a time, or an offset from the true one
  echo "$1" >"$work/clock.new"
  mv "$work/clock.new" "$work/clock"
}
faked() { # in the background only: replaces the shell
  exec env LD_PRELOAD="$library" FAKETIME_TIMESTAMP_FILE="$work/clock" FAKETIME_NO_CACHE=1 \
    FAKETIME_DONT_FAKE_MONOTONIC=1 DONT_FAKE_MONOTONIC=1 "$@"
}
# newest_stamp TOPIC: whole seconds of the stamp of the newest message in echo.txt
newest_stamp() { grep "^[^ ]*$1" "$work/echo.txt" | tail -n 1 | sed -n 's/.* t *\([0-9]*\)\..*/\1/p'; }
near() { # TOPIC SECONDS: its newest stamp is within 3 s of that time
  local stamp
  stamp=$(newest_stamp "$1")
  [ -n "$stamp" ] || fail "no $1 was received"
  [ $((stamp > $2 ? stamp - $2 : $2 - stamp)) -le 3 ] || fail "$1 is stamped $stamp at $2"
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 14 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
set_clock '@2025-01-01 00:00:00'
faked "$isobard" --config "$work/isobar.toml" --output "$work/run" >"$work/isobard.log" 2>&1 &
daemon=$!
pids+=("$daemon")
wait_for 'ready:' "$work/isobard.log"
faked "$bridge" --config "$work/isobar.toml" >"$work/bridge.log" 2>&1 &
pids+=("$!")
"$isobar" echo pose odom --rate 10 --timeout 0 >"$work/echo.txt" 2>"$work/echo.log" &
pids+=("$!")
"$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
play=$!
pids+=("$play")

sleep 5
in_2025=$(TZ=UTC date -d '2025-01-01' +%s)
for topic in pose odom; do
  stamp=$(newest_stamp $topic)
  [ -n "$stamp" ] && [ $((stamp - in_2025)) -lt 86400 ] && [ "$stamp" -ge $((in_2025 - 86400)) ] ||
    fail "$topic is stamped '$stamp' before the clock is set"
done
ok "before the clock is set, poses speak from 2025"
set_clock '+0'
sleep 3
for topic in pose odom; do near $topic "$(date +%s)"; done
ok "pose and odom follow the system clock by two years"
set_clock '-3d'
sleep 3
for topic in pose odom; do near $topic $(($(date +%s) - 3 * 86400)); done
ok "pose and odom follow the system clock three days back"

# Futex waits until a time of the system clock (FUTEX_CLOCK_REALTIME, 0x100): after a step back they sleep for days.
if [ "$(uname -m)" = x86_64 ]; then
  for _ in $(seq 20); do
    for pid in "${pids[@]:0:2}"; do
      asleep=$(cat /proc/"$pid"/task/*/syscall 2>/dev/null | awk '$1 == 202 && $3 ~ /^0x1..$/ && $5 != "0x0"')
      [ -z "$asleep" ] || fail "threads of process $pid wait for a time of the system clock: $asleep"
      [ "$(cat /proc/"$pid"/task/*/syscall | wc -l)" -gt 5 ] || fail "the threads of process $pid are not seen"
    done
    sleep 0.05
  done
  ok "no thread waits for a time of the system clock"
fi

wait "$play" || fail "play"
kill -TERM "$daemon"
wait "$daemon" || fail "isobard did not stop with code 0"
steps=$(grep -c 'the system clock was set by' "$work/isobard.log")
[ "$steps" -eq 2 ] || fail "$steps lines about two steps of the clock"
if grep -q 'clock_steps' "$work/isobard.log"; then fail "senders are blamed for the machine's clock"; fi
gap=$(awk '/^#/ { next } last > 0 && $1 - last > worst { worst = $1 - last } last > 0 && $1 <= last { worst = 999 }
  { last = $1; n++ } END { printf "%.3f %d", worst, n }' "$work/run/trajectory.tum")
awk -v g="$gap" 'BEGIN { split(g, v, " "); exit !(v[1] < 0.35 && v[2] > 95) }' || fail "largest gap and number of poses: $gap"
ok "two steps told once each; no pose lost (largest gap in s, poses: $gap)"
