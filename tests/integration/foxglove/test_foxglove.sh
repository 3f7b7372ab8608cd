#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `isobar foxglove` behind isobar-dds, looked at by Foxglove's own client; a port in use; a polite end.
# Usage: test_foxglove.sh ISOBAR ISOBAR-DDS STAND-IN NODE CLIENT   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 bridge=$2 stand_in=$3 node=$4 client=$5
work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
wait_for() { for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done; fail "\"$1\" did not come in $2"; }

"$stand_in" >"$work/stand_in.log" 2>&1 &
wait_for ready "$work/stand_in.log"
"$bridge" >"$work/bridge.log" 2>&1 &
"$isobar" foxglove --port 18765 >"$work/foxglove.log" 2>&1 &
server=$!
wait_for 'ready: in Foxglove' "$work/foxglove.log"
code=0
"$node" "$client" ws://127.0.0.1:18765 >"$work/client.log" 2>&1 || code=$?
[ "$code" -eq 77 ] && exit 77
[ "$code" -eq 0 ] || fail "$(cat "$work/client.log")"
cat "$work/client.log"

# The same topics in a file.
reader=$(dirname "$client")/read_mcap.js
"$isobar" record "$work/drive" --mcap --for 2.5 --min-free 1 >"$work/record.log" 2>&1 || fail "record --mcap"
"$node" "$reader" "$work/drive.mcap" >"$work/read.log" 2>&1 || fail "$(cut -c 1-2000 "$work/read.log")"
for topic in /pose /odom /tf /tf_static /altitude /registered_scan /map_cloud /diagnostics; do
  grep -q "\"$topic\":" "$work/read.log" || fail "no $topic in drive.mcap: $(cut -c 1-2000 "$work/read.log")"
done

code=0
"$isobar" foxglove --port 18765 >"$work/second.log" 2>&1 || code=$?
[ "$code" -eq 69 ] && grep -q 'port 18765 of 127.0.0.1 cannot be opened' "$work/second.log" || fail "code $code for a port in use"
kill -TERM "$server"
wait "$server" || fail "no polite end"
