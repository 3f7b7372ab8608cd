#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `isobar record` and the black box on a running isobard: recordings of it replay, whatever ends abruptly.
# Usage: test_record.sh ISOBAR ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2

work=$(mktemp -d)
pids=()
finish() {
  for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done
  umount "$work/small" 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
export RUNTIME_DIRECTORY="$work/runtime"
mkdir "$RUNTIME_DIRECTORY"
checks=0
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
wait_for() { # WORDS FILE: at most 20 s
  for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}
stop_isobard() { kill -TERM "$daemon"; wait "$daemon" || fail "isobard did not stop with code 0"; }
start_isobard() { # NAME: its log and run folder
  "$isobard" --config "$work/isobar.toml" --output "$work/$1" >"$work/$1.log" 2>&1 &
  daemon=$!
  pids+=("$daemon")
  wait_for 'ready:' "$work/$1.log"
}
start_record() { # NAME
  "$isobar" record "$work/$1" --min-free 1 >"$work/$1.log" 2>&1 &
  recorder=$!
  pids+=("$recorder")
  wait_for 'recording to' "$work/$1.log"
}
rows() { grep -c '^[0-9]' "$1"; }
# replays RECORDING: twice, with the same bits both times; leaves the result in RECORDING.replay
replays() {
  for i in 1 2; do
    "$isobar" replay "$1" --config "$1/settings.toml" --out "$1.replay$i" >"$work/replay.log" 2>&1 || fail "no replay of $1"
  done
  cmp -s "$1.replay1/trajectory.tum" "$1.replay2/trajectory.tum" || fail "two replays of $1 differ"
  cmp -s "$1.replay1/map.ply" "$1.replay2/map.ply" || fail "two replays of $1 have different maps"
}
largest_error() { # REFERENCE RUN
  "$isobar" evaluate "$1/reference.tum" "$2" --json "$work/figures.json" >"$work/evaluate.log" || fail "no evaluation of $2"
  grep -o '"ate_max_m": *[-0-9.e]*' "$work/figures.json" | sed 's/.*: *//'
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 12 --out "$work/source" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/source" >"$work/isobar.toml"

# A whole run, recorded.
"$isobar" record "$work/early" --min-free 1 >"$work/early.log" 2>&1 &
early=$!
pids+=("$early")
wait_for 'waiting for isobard' "$work/early.log"
start_isobard run
wait_for 'recording to' "$work/early.log"
start_record taken
"$isobar" play "$work/source" --reference-out "$work/played" >"$work/play.log" 2>&1
sleep 1
kill -INT "$recorder"
wait "$recorder" || fail "the recorder did not end with code 0 at SIGINT"
grep -q ' 0 lost' "$work/taken.log" || fail "inputs were lost"
packets=$(grep -o '^[0-9]* packets' "$work/taken.log")
[ "${packets% *}" -gt 8000 ] || fail "only $packets of 12 s"
for sensor in imu barometer base_barometer wheel; do
  sent=$(rows "$work/source/$sensor.csv") got=$(rows "$work/taken/$sensor.csv")
  [ "$got" -ge $((sent - 2)) ] && [ "$got" -le "$sent" ] || fail "$got of $sent rows of $sensor recorded"
done
ok "$packets and all samples recorded, none lost"
replays "$work/taken"
stop_isobard
[ ! -e "$RUNTIME_DIRECTORY/blackbox" ] || fail "a clean end leaves a ring in memory"
live=$(largest_error "$work/played" "$work/run") replayed=$(largest_error "$work/played" "$work/taken.replay1")
awk -v l="$live" -v r="$replayed" 'BEGIN { exit !(r < 0.3 && r < l + 0.05) }' || fail "largest error $replayed m replayed, $live m live"
ok "two replays are identical, with a largest error of $replayed m (live: $live m)"
"$isobar" record "$work/taken" >"$work/refused.log" 2>&1 && fail "an existing folder was accepted"
grep -q 'exists already' "$work/refused.log" || fail "no reason for the refusal"
ok "an existing folder is refused"

# kill -9 of the recorder: at most a second is missing.
start_isobard second
start_record killed
"$isobar" play "$work/source" >"$work/play.log" 2>&1 &
play=$!
sleep 6
kill -9 "$recorder"
killed_at=$(date +%s.%N)
last=$(tail -n 2 "$work/killed/imu.csv" | head -n 1 | cut -d, -f1)
awk -v k="$killed_at" -v l="$last" 'BEGIN { exit !(k - l * 1e-9 < 1.5) }' || fail "the recording ends more than a second before the kill"

# kill -9 of isobard, while the player still sends: the next one saves the black box of the run.
kill -9 "$daemon"
killed_at=$(date +%s.%N)
wait "$play"
replays "$work/killed"
ok "kill -9 of the recorder loses at most a second, and the rest replays"
start_isobard again
wait_for 'black box saved (crash)' "$work/again.log"
crash=$(echo "$work"/again/blackbox/*-crash)
last=$(tail -n 1 "$crash/imu.csv" | cut -d, -f1)
awk -v k="$killed_at" -v l="$last" 'BEGIN { exit !(k - l * 1e-9 < 1.0) }' || fail "the black box ends more than a second before the kill"
replays "$crash"
[ "$(ls "$RUNTIME_DIRECTORY/blackbox" | wc -l)" -eq 1 ] || fail "the ring of the killed run is still in memory"
ok "after kill -9 of isobard its black box is saved, to the last second, and replays"

wait_for 'waiting for it to start again' "$work/early.log"
before=$(rows "$work/early/imu.csv")
"$isobar" play "$work/source" >"$work/play.log" 2>&1
sleep 1
after=$(rows "$work/early/imu.csv")
[ $((after - before)) -ge 2000 ] || fail "the recorder did not go on after the restart of isobard"
ok "the recorder goes on after a restart of isobard ($((after - before)) imu samples more)"

# On demand, by command and by signal.
"$isobar" blackbox save --reason "Odd turn" >"$work/save.log" 2>&1 || fail "not saved"
saved=$(sed -n 's/^written: //p' "$work/save.log")
case $saved in */again/blackbox/*Z-odd-turn) ;; *) fail "saved to $saved" ;; esac
replays "$saved"
ok "saved on demand, and it replays"
kill -USR1 "$daemon"
wait_for 'black box saved (signal)' "$work/again.log"
wait_for 'black box saved (fault-' "$work/again.log"  # the player has stopped: the sensors are silent
ok "saved by SIGUSR1, and on the fault of a silent sensor"
"$isobar" blackbox status >"$work/status.log" 2>&1 || fail "no status"
grep -q '0 inputs lost' "$work/status.log" || fail "the black box has lost inputs: $(cat "$work/status.log")"
ok "$(head -n 1 "$work/status.log")"

if [ "${ISOBAR_ISOLATED:-}" = yes ]; then
  mkdir "$work/small"
  mount -t tmpfs -o size=12m tmpfs "$work/small"
  "$isobar" record "$work/small/none" --min-free 100 >"$work/full.log" 2>&1 && fail "recording began on a full disk"
  grep -q 'MB free.*nothing is recorded' "$work/full.log" || fail "no reason for the full disk"
  got=0
  "$isobar" play "$work/source" >"$work/play.log" 2>&1 &
  play=$!
  timeout 30 "$isobar" record "$work/small/part" --min-free 4 >"$work/full.log" 2>&1 || got=$?
  [ "$got" -eq 69 ] || fail "exit code $got on a full disk"
  grep -q 'MB free.*is complete' "$work/full.log" || fail "no reason for the end"
  kill "$play" 2>/dev/null || true
  wait "$play" 2>/dev/null || true
  replays "$work/small/part"
  ok "a recording ends before the disk is full, says so, and replays"
fi

kill -TERM "$early"
wait "$early" || fail "the recorder did not end with code 0 at SIGTERM"
stop_isobard
[ ! -e "$RUNTIME_DIRECTORY/blackbox" ] || fail "a clean end leaves a ring in memory"
ok "a clean end leaves nothing in memory"
echo "$checks checks"
