# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# One isobard after another in a work folder, for tests that source this file with `isobar` and `isobard` set.
work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; umount "$work/small" 2>/dev/null || true; rm -rf "$work"; }
trap finish EXIT
checks=0
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }
ok() { checks=$((checks + 1)); echo "ok: $*"; }
wait_for() { # WORDS FILE: at most 20 s
  for _ in $(seq 200); do grep -q -- "$1" "$2" 2>/dev/null && return 0; sleep 0.1; done
  fail "\"$1\" did not come in $2"
}
start() { # LOG FOLDER
  "$isobard" --config "$work/isobar.toml" --output "$2" >"$work/$1.log" 2>&1 &
  daemon=$!
  pids+=("$daemon")
  wait_for 'ready:' "$work/$1.log"
}
stop() {
  kill -TERM "$daemon" || fail "isobard has ended by itself"
  wait "$daemon" || fail "isobard did not stop with code 0"
}
lines_of() { grep -vc '^#' "$1" || true; }
