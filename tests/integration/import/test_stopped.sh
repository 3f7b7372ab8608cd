#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# A stopped or failed import or replay leaves nothing behind, and never touches what was there.
#   test_stopped.sh ISOBAR
set -u
isobar=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work/tmp
mkdir "$TMPDIR"
fail() { echo "FAILED: $*"; exit 1; }
ok() { echo "ok: $*"; }

"$isobar" simulate three-floors --stop-after 8 --out "$work/recording" >/dev/null || fail "no recording"
capture=$work/recording/lidar.pcap

# stopped SIGNAL CODE COMMAND…: sends the signal once the folder of the command has begun.
stopped() {
  local signal=$1 code=$2 out=$work/out
  shift 2
  "$isobar" "$@" --out "$out" >"$work/stdout" 2>"$work/stderr" &
  local pid=$!
  for _ in $(seq 300); do
    [ -e "$out" ] && break
    sleep 0.02
  done
  kill -"$signal" "$pid"
  wait "$pid"
  local rc=$?
  [ "$rc" = "$code" ] || fail "$1: exit code $rc after SIG$signal: $(cat "$work/stderr")"
  [ ! -e "$out" ] || fail "$1: left $(ls "$out")"
  [ -z "$(ls "$TMPDIR")" ] || fail "$1: left $(ls "$TMPDIR") in TMPDIR"
  grep -q "stopped" "$work/stderr" || fail "$1: said $(cat "$work/stderr")"
  ok "$1 after SIG$signal"
}
stopped TERM 143 replay "$capture"
# Not INT: what a script starts in the background ignores it.
stopped HUP 129 replay "$capture"

# A limit of the file size is a full disk: the error is said, nothing stays.
(ulimit -f 100; "$isobar" import "$capture" --out "$work/small" 2>"$work/stderr")
rc=$?
[ "$rc" = 65 ] || fail "exit code $rc on a full disk: $(cat "$work/stderr")"
[ ! -e "$work/small" ] || fail "a full disk left $(ls "$work/small")"
ok "full disk: $(cat "$work/stderr")"

mkdir "$work/mine"
echo mine >"$work/mine/notes"
"$isobar" import "$capture" --out "$work/mine" 2>/dev/null && fail "wrote into a folder of somebody else"
[ "$(cat "$work/mine/notes")" = mine ] || fail "changed a file of somebody else"
ok "a folder of somebody else is left alone"
