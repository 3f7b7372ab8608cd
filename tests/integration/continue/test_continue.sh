#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobard is killed, restarted, moved, and loses its disk: nothing that it had written is lost, and it goes on.
# Usage: test_continue.sh ISOBAR ISOBARD [SECONDS-TO-FIRST-POSE]   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2 limit_s=${3:-6}

# shellcheck source=tests/integration/continue/one_service.sh
source "$(dirname "$0")/one_service.sh"
whole_lines() { # FILE: eight numbers on every line, and a line end
  [ -z "$(tail -c 1 "$1")" ] || fail "the last line of $1 is cut"
  awk '!/^#/ && NF != 8 { bad = 1 } END { exit bad }' "$1" || fail "a line of $1 is cut"
}
points_of() { sed -n 's/^\([0-9]*\) points of .*/\1/p' "$1"; }

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 22 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" simulate city --seed 2 --short --stop-after 14 --out "$work/elsewhere" >>"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
run=$work/run

# 1. kill -9 in the drive. The robot drives on.
start first "$run"
"$isobar" play "$work/recording" --reference-out "$work/played" >"$work/play.log" 2>&1 &
play=$!
sleep 12
"$isobar" map export "$run" --out "$work/during.ply" >"$work/export.log" 2>&1 || fail "map export in the run: $(cat "$work/export.log")"
[ "$(points_of "$work/export.log")" -gt 1000 ] || fail "map export in the run: $(cat "$work/export.log")"
ok "the map of a running isobard: $(points_of "$work/export.log") points"
kill -9 "$daemon"
wait "$daemon" 2>/dev/null || true
whole_lines "$run/trajectory.tum"
before=$(lines_of "$run/trajectory.tum")
last=$(tail -n 1 "$run/trajectory.tum" | cut -d ' ' -f 1)
tiles_before=$("$isobar" map info "$run" | sed -n 's/^tiles: \([0-9]*\) .*/\1/p')
cp "$run/trajectory.tum" "$work/before.tum"
[ "$before" -ge 80 ] || fail "only $before poses of 12 s"
# A crash between two writes loses 0.5 s and the time of one write; 1 s is promised. The machine may be busy.
start second "$run"
grep -q 'continues the earlier run in frame map' "$work/second.log" || fail "the second start says nothing"
grep -q 'scans of the journal are inserted' "$work/second.log" || fail "the second start has no journal"
wait "$play"
sleep 1
stop
[ -z "$(find "$run/map" -maxdepth 1 -name '*.scans')" ] || fail "the journal is left after a polite end, which has written all tiles"
cmp -n "$(stat -c %s "$work/before.tum")" "$work/before.tum" "$run/trajectory.tum" || fail "the old poses were changed"
whole_lines "$run/trajectory.tum"
[ ! -e "$run/trajectory_2.tum" ] || fail "a new frame was begun"
[ "$(lines_of "$run/trajectory.tum")" -gt $((before + 20)) ] || fail "only $(lines_of "$run/trajectory.tum") poses after $before"
first=$(awk -v last="$last" '!/^#/ && $1 > last { print $1; exit }' "$run/trajectory.tum")
gap=$(awk -v a="$last" -v b="$first" 'BEGIN { printf "%.2f", b - a }')
# 3 s are promised from the start of the process to the first pose, on a machine that is not busy.
awk -v g="$gap" -v limit="$limit_s" 'BEGIN { exit !(g < limit) }' ||
  fail "$gap s between the last pose before and the first after kill -9"
ok "poses again $gap s after kill -9, in the same frame and file"
"$isobar" evaluate "$work/played/reference.tum" "$run" --json "$work/figures.json" >"$work/evaluate.log"
largest=$(grep -o '"ate_max_m": *[-0-9.e]*' "$work/figures.json" | sed 's/.*: *//')
awk -v e="$largest" 'BEGIN { exit !(e < 0.4) }' || fail "position off by $largest m over the restart"
ok "position within 40 cm over the restart (largest error $largest m)"
tiles_after=$("$isobar" map info "$run" | sed -n 's/^tiles: \([0-9]*\) .*/\1/p')
[ "$tiles_after" -ge "$tiles_before" ] || fail "$tiles_before tiles before, $tiles_after after"
"$isobar" map check "$run" >"$work/check.log" || fail "the map is damaged: $(cat "$work/check.log")"
ok "$tiles_after tiles after $tiles_before, no damage"

# 2. In another place the next morning: a new frame, beside the old one.
cp "$run/trajectory.tum" "$work/before.tum"
"$isobar" map export "$run" --out "$work/old.ply" >/dev/null
start moved "$run"
"$isobar" play "$work/elsewhere" >"$work/play.log" 2>&1
sleep 1
stop
cmp "$work/before.tum" "$run/trajectory.tum" || fail "poses of another place were written into the old frame"
whole_lines "$run/trajectory_2.tum"
[ "$(lines_of "$run/trajectory_2.tum")" -ge 20 ] || fail "no poses in the new frame"
"$isobar" map export "$run/map" --out "$work/new.ply" >/dev/null
cmp "$work/old.ply" "$work/new.ply" || fail "the old map was changed"
"$isobar" map export "$run/map_2" --out "$work/second.ply" >"$work/export.log" 2>&1 || fail "no map of the new frame"
ok "another place: $(lines_of "$run/trajectory_2.tum") poses and $(points_of "$work/export.log") points in frame map_2, the old ones untouched"

# 3. A new frame on command.
start reset "$work/reset"
timeout 14 "$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
play=$!
sleep 8
"$isobar" reset >"$work/command.log" 2>&1 || fail "isobar reset: $(cat "$work/command.log")"
wait "$play" || true
stop
[ "$(lines_of "$work/reset/trajectory.tum")" -ge 40 ] || fail "no poses before the reset"
[ "$(lines_of "$work/reset/trajectory_2.tum")" -ge 20 ] || fail "no poses after the reset"
"$isobar" map check "$work/reset/map_2" >"$work/check.log" || fail "no map after the reset: $(cat "$work/check.log")"
ok "a new frame on command: $(lines_of "$work/reset/trajectory.tum") poses in map, $(lines_of "$work/reset/trajectory_2.tum") in map_2"

# 4. Folders of others.
mkdir "$work/home"
echo thesis >"$work/home/00000000.tiles"
for option in output.directory map.directory; do
  (cat "$work/isobar.toml"; echo) | sed "s|^$option = .*|$option = \"$work/home\"|" >"$work/foreign.toml"
  grep -q "^$option = \"$work/home\"" "$work/foreign.toml" || printf '[%s]\ndirectory = "%s"\n' "${option%.*}" "$work/home" >"$work/foreign.toml"
  code=0
  timeout 20 "$isobard" --config "$work/foreign.toml" >"$work/foreign.log" 2>&1 || code=$?
  [ "$code" -eq 78 ] || fail "exit code $code for $option on a folder of others"
  grep -q "$option: $work/home holds files of others" "$work/foreign.log" || fail "$option: no sentence"
  [ "$(cat "$work/home/00000000.tiles")" = thesis ] && [ "$(ls "$work/home")" = 00000000.tiles ] || fail "$option touched a folder of others"
done
ok "folders of others are refused and untouched"

# 5. The folder is deleted in the run.
start deleted "$work/gone"
"$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
play=$!
sleep 6
rm -r "$work/gone"
wait "$play"
sleep 1
stop
whole_lines "$work/gone/trajectory.tum"
[ "$(lines_of "$work/gone/trajectory.tum")" -ge 50 ] || fail "poses went into a deleted file"
[ -s "$work/gone/counters.csv" ] || fail "no counters.csv"
"$isobar" map check "$work/gone" >"$work/check.log" || fail "no map after its folder was deleted: $(cat "$work/check.log")"
ok "a deleted folder is written anew: $(lines_of "$work/gone/trajectory.tum") poses"

# 6. The disk is full, and has room again.
if [ "${ISOBAR_ISOLATED:-}" = yes ]; then
  mkdir "$work/small"
  mount -t tmpfs -o size=4m tmpfs "$work/small"
  start full "$work/small/run"
  head -c 100m /dev/zero >"$work/small/filler" 2>/dev/null || true
  "$isobar" play "$work/recording" >"$work/play.log" 2>&1 &
  play=$!
  wait_for 'No space left on device' "$work/full.log"
  # What one writer gives up, another may take: the disk is filled again until the trajectory fails, too.
  for _ in $(seq 100); do
    grep -q 'writing resumes when the disk allows' "$work/full.log" && break
    head -c 100m /dev/zero >>"$work/small/filler" 2>/dev/null || true
    sleep 0.2
  done
  wait_for 'writing resumes when the disk allows' "$work/full.log"
  sleep 4
  rm "$work/small/filler"
  mount -o remount,size=60m "$work/small"
  wait_for 'writing to the disk has resumed' "$work/full.log"
  wait "$play"
  sleep 1
  stop
  whole_lines "$work/small/run/trajectory.tum"
  poses=$(lines_of "$work/small/run/trajectory.tum")
  [ "$poses" -ge 150 ] || fail "only $poses poses of 22 s: those of the full disk are lost"
  [ -s "$work/small/run/counters.csv" ] || fail "no counters.csv"
  [ "$(grep -c 'No space left' "$work/full.log")" -le 5 ] || fail "more than a few lines about the full disk"
  ok "a full disk: $poses poses, none lost, $(grep -c 'No space left' "$work/full.log") lines in the log"
fi
echo "$checks checks"
