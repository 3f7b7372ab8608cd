#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A robot that was carried away overnight: with a hint it goes on in its map, without one a new frame begins. A wrong hint
# changes nothing.
# Usage: test_hint.sh ISOBAR ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2

# shellcheck source=tests/integration/continue/one_service.sh
source "$(dirname "$0")/one_service.sh"
refused() { # WORDS ARGUMENTS…: the hint is refused with these words, exit code 69
  local words=$1 code=0
  shift
  timeout 40 "$isobar" initial-pose "$@" >"$work/refused.log" 2>&1 || code=$?
  [ "$code" -eq 69 ] || fail "exit code $code of initial-pose $*: $(cat "$work/refused.log")"
  grep -q -- "$words" "$work/refused.log" || fail "no \"$words\" in: $(cat "$work/refused.log")"
  ok "$(cat "$work/refused.log")"
}

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 22 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
run=$work/run
start first "$run"
"$isobar" play "$work/recording" >"$work/play.log" 2>&1
sleep 1
stop
poses=$(lines_of "$run/trajectory.tum")
read -r x y < <(tail -n 1 "$run/trajectory.tum" | awk '{ print $2, $3 }')
awk -v x="$x" -v y="$y" 'BEGIN { exit !(x * x + y * y > 4) }' || fail "the robot ends $x, $y from its start: too near for the test"
ok "$poses poses; the robot ends at $x, $y"
cp -r "$run" "$work/control"

# The robot is carried back to its start, which is in the map and beyond the search around the last place.
start control "$work/control"
"$isobar" play "$work/recording" >"$work/play.log" 2>&1
sleep 1
stop
# Without a hint the search of the whole map finds the robot, or a new frame begins, or, in a corridor that looks alike all
# along, a place near the last one is confirmed, or, on a busy machine, none of it until the drive is over.
if [ -e "$work/control/trajectory_2.tum" ]; then
  ok "without a hint a new frame begins"
elif [ "$(lines_of "$work/control/trajectory.tum")" -le "$poses" ]; then
  ok "without a hint no place is confirmed"
else
  read -r x y < <(grep -v '^#' "$work/control/trajectory.tum" | sed -n "$((poses + 1))p" | awk '{ print $2, $3 }')
  ok "without a hint the robot is taken to be at $x, $y"
fi

start hinted "$run"
"$isobar" initial-pose 0.4 -0.3 8 --timeout 25 >"$work/hint.log" 2>&1 &
hint=$!
sleep 1
"$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
play=$!
pids+=("$play")
wait "$hint" || fail "the hint: $(cat "$work/hint.log")"
grep -q '^hint taken' "$work/hint.log" || fail "the hint: $(cat "$work/hint.log")"
ok "$(cat "$work/hint.log")"
refused 'refused: no hypothesis around it matches' 50 50 0
refused 'refused: the altimeter says another height' 0 0 0 --z 9
code=0
"$isobar" initial-pose nan 0 0 >"$work/refused.log" 2>&1 || code=$?
[ "$code" -eq 64 ] || fail "exit code $code of a hint that is no number"
wait "$play"
sleep 1
stop
[ ! -e "$run/trajectory_2.tum" ] || fail "a new frame was begun in spite of the hint"
[ "$(lines_of "$run/trajectory.tum")" -gt $((poses + 80)) ] || fail "only $(lines_of "$run/trajectory.tum") poses after $poses"
# The robot stands at its start, or has left it by a metre before a busy machine has confirmed it. Wrong places are 5 m away.
read -r x y < <(grep -v '^#' "$run/trajectory.tum" | sed -n "$((poses + 1))p" | awk '{ print $2, $3 }')
awk -v x="$x" -v y="$y" 'BEGIN { exit !(x * x + y * y < 1.5) }' || fail "the first pose after the hint is at $x, $y"
# The second drive ends where the first one did.
read -r x1 y1 < <(grep -v '^#' "$run/trajectory.tum" | sed -n "${poses}p" | awk '{ print $2, $3 }')
read -r x2 y2 < <(tail -n 1 "$run/trajectory.tum" | awk '{ print $2, $3 }')
awk -v x="$x1" -v y="$y1" -v u="$x2" -v v="$y2" 'BEGIN { exit !((x - u)^2 + (y - v)^2 < 0.04) }' ||
  fail "the second drive ends at $x2, $y2, the first one ended at $x1, $y1"
ok "in the old frame, from $x, $y to $x2, $y2; the first drive ended at $x1, $y1"
"$isobar" map check "$run" >"$work/check.log" || fail "the map is damaged: $(cat "$work/check.log")"
echo "$checks checks"
