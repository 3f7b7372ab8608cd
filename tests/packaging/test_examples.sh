#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The examples of the package: configurations are whole, layouts and parameters name topics that isobar-dds publishes with
# types that fit, the feeder feeds isobard. Docker and ROS 2 themselves are not on the test machine.
# Usage: test_examples.sh SOURCE ISOBAR ISOBARD   (through tests/ipc/isolated, where root)
set -euo pipefail
source=$1 isobar=$2 isobard=$3
examples=$source/packaging/examples
work=$(mktemp -d)
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true; rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

for config in "$examples"/*.toml; do
  "$isobar" config check "$config" >"$work/check.log" 2>&1 || fail "$config: $(cat "$work/check.log")"
done

# Topics that are published or taken, with the paths of an exported run.
topics=$(sed -n 's/^inline const DdsTopic<.*{"\([a-z_]*\)",.*/\1/p' "$source/ipc/dds/topics.hpp" | sort -u)
for file in foxglove-layout.json isobar.rviz nav2.yaml robot_localization.yaml; do
  [ -s "$examples/$file" ] || fail "$file is missing"
  used=$(grep -oE '(: |"|: ")/[a-z_]+' "$examples/$file" | grep -oE '[a-z_]+' | sort -u)
  [ -n "$used" ] || fail "$file names no topic"
  for topic in $used; do
    case $topic in path | path_corrected | initialpose) continue ;; esac
    grep -qx "$topic" <<<"$topics" || fail "$file: isobar-dds has no topic /$topic"
  done
done
python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$examples/foxglove-layout.json" || fail "foxglove-layout.json"
if python3 -c 'import yaml' 2>/dev/null; then
  for file in isobar.rviz nav2.yaml robot_localization.yaml; do
    python3 -c 'import sys, yaml; yaml.safe_load(open(sys.argv[1]))' "$examples/$file" || fail "$file is no YAML"
  done
fi
# Every option of the settings that a comment tells to write exists.
grep -ohE '^# +[a-z_]+ = ' "$examples"/*.yaml | grep -oE '[a-z_]+' | sort -u | while read -r key; do
  grep -q "^dds.$key = " "$source/config/isobar.toml" || fail "dds.$key is no setting"
done

printf '[lidar]\nport = 12368\n[input]\nexpect_base_station = false\n' >"$work/isobar.toml"
"$isobard" --config "$work/isobar.toml" --output "$work/run" >"$work/isobard.log" 2>&1 &
daemon=$!
for _ in $(seq 100); do grep -q 'ready:' "$work/isobard.log" && break; sleep 0.1; done
grep -q 'ready:' "$work/isobard.log" || fail "$(cat "$work/isobard.log")"
for _ in $(seq 40); do echo "1008.43 21.4"; sleep 0.05; done | python3 "$examples/feeder.py"
for _ in $(seq 50); do
  "$isobar" status --json >"$work/status.json" 2>/dev/null || true
  samples=$(python3 -c 'import json, sys
for sensor in json.load(open(sys.argv[1]))["sensors"]:
    if sensor["name"] == "barometer": print(sensor["samples"] or 0)' "$work/status.json" 2>/dev/null || echo 0)
  [ "${samples:-0}" -ge 40 ] && break
  sleep 0.1
done
[ "${samples:-0}" -eq 40 ] || fail "of 40 samples of the feeder isobard has ${samples:-none}: $(cat "$work/status.json")"
echo "ok: configurations, layouts and parameters, and 40 samples of the feeder"
