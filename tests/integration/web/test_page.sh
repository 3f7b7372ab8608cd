#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# isobar web in Chromium, beside isobard and isobar-dds: before, during and after a drive, and over a restart.
# Usage: test_page.sh ISOBAR ISOBARD ISOBAR-DDS NODE   (through tests/ipc/isolated, where root)
set -euo pipefail
isobar=$1 isobard=$2 bridge=$3 node=$4
here=$(cd "$(dirname "$0")" && pwd)
command -v chromium >/dev/null || { echo "skipped: needs the Debian package chromium"; exit 77; }
[ -d "$here/npm/node_modules/puppeteer-core" ] && [ -d "$here/npm/node_modules/axe-core" ] || { echo "skipped: run npm ci in $here/npm first"; exit 77; }
if "$isobar" web /nonexistent 2>&1 | grep -q 'without its page'; then echo "skipped: built without the page"; exit 77; fi

work=$(mktemp -d)
pids=()
finish() { for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done; rm -rf "$work"; }
trap finish EXIT
fail() { echo "FAILED: $*"; for log in "$work"/*.log; do echo "--- $log"; tail -n 20 "$log"; done; exit 1; }

"$isobar" simulate stairs-demo --seed 5 --short --stop-after 30 --out "$work/recording" >"$work/simulate.log" 2>&1
"$isobar" config show --sensors-of "$work/recording" >"$work/isobar.toml"
echo 'a-token-of-this-test' >"$work/token"
chmod 600 "$work/token"
"$isobar" web --port 18080 --token-file "$work/token" --viewers 3 >"$work/web.log" 2>&1 &
pids+=("$!")
# What the page's test asks for, one word a line: start, play, unplug, kill; end, when it has ended.
mkfifo "$work/orders"
exec 4<>"$work/orders"
start() {
  "$isobard" --config "$work/isobar.toml" --output "$work/run" >>"$work/isobard.log" 2>&1 &
  daemon=$!
  pids+=("$daemon")
}
"$bridge" --config "$work/isobar.toml" >"$work/bridge.log" 2>&1 &
pids+=("$!")
"$isobar" echo pose --rate 1000 --timeout 0 >"$work/echo.txt" 2>"$work/echo.log" &
pids+=("$!")
"$node" "$here/page.mjs" http://localhost:18080/ "$work/echo.txt" "$work/orders" >"$work/page.log" 2>&1 &
page=$!
pids+=("$page")
# Without a time limit in read, which would lose what it has read of a line.
(while kill -0 "$page" 2>/dev/null; do sleep 0.2; done; echo end >&4) &
while read -r -u 4 order; do
  case $order in
    start) start ;;
    play) "$isobar" play "$work/recording" >"$work/play.log" 2>&1 & played=$! pids+=("$!") ;;
    unplug) kill "$played" ;;
    kill) kill -9 "$daemon" ;;
    end) break ;;
  esac
done
wait "$page" || fail "the page is not as it should be"
cat "$work/page.log"
