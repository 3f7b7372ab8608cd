#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Units: systemd-analyze has nothing to say about them, and their exposure is at most 2.0.
# Usage: test_units.sh SYSTEMD_FOLDER ISOBARD ISOBAR_DDS ISOBAR
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
check() { if [ "$2" = yes ]; then echo "ok: $1"; else echo "FAILED: $1"; failed=1; fi; }

for unit in isobard.service isobar-dds.service isobar-metrics.service isobar-web.service run-isobar.mount; do
  sed -e "s#^ExecStart=/usr/bin/isobard #ExecStart=$2 #; s#^ExecStart=/usr/bin/isobar-dds #ExecStart=$3 #; s#^ExecStart=/usr/bin/isobar #ExecStart=$4 #" "$1/$unit" \
    >"$folder/$unit"
done
for unit in isobard isobar-dds isobar-metrics isobar-web; do
  install -D -m 644 "$1/shared-memory.conf" "$folder/$unit.service.d/shared-memory.conf"
done
# Its exit code is 0 also after "Unknown key name …, ignoring".
said=$(SYSTEMD_LOG_LEVEL=info systemd-analyze verify --man=no "$folder"/*.service "$folder"/*.mount 2>&1 || true)
check "systemd-analyze verify says nothing: $said" "$([ -z "$said" ] && echo yes)"

for unit in isobard isobar-dds isobar-metrics isobar-web; do
  exposure=$(systemd-analyze security --offline=true --no-pager "$folder/$unit.service" |
    sed -n 's/.*Overall exposure level.*: \([0-9.]*\) .*/\1/p')
  check "exposure of $unit is ${exposure:-unknown}, at most 2.0" \
    "$(awk -v e="${exposure:-10}" 'BEGIN { if (e <= 2.0) print "yes" }')"
  check "$unit.service: /dev/shm and /tmp are the services' own" "$(grep -qxF \
    'BindPaths=/run/isobar/shm:/dev/shm /run/isobar/tmp:/tmp' "$folder/$unit.service.d/shared-memory.conf" && echo yes)"
  # What the services rely on, whatever the score says.
  for line in StartLimitIntervalSec=0 Restart=always User=isobar PrivateTmp=yes; do
    check "$unit.service: $line" "$(grep -qxF "$line" "$folder/$unit.service" && echo yes)"
  done
done
for unit in isobar-metrics isobar-web; do
  check "$unit.service: loopback only" "$(grep -qxF IPAddressDeny=any "$folder/$unit.service" && grep -qxF IPAddressAllow=localhost "$folder/$unit.service" && echo yes)"
done
for line in CPUQuota=50% MemoryMax=512M; do
  check "isobar-web.service: $line" "$(grep -qxF "$line" "$folder/isobar-web.service" && echo yes)"
done
for unit in isobard isobar-dds; do
  check "$unit.service: SIGHUP reloads" "$(grep -qxF 'ExecReload=/bin/kill -HUP $MAINPID' "$folder/$unit.service" && echo yes)"
done
check "isobard shares /tmp with isobar-dds" "$(grep -qx JoinsNamespaceOf=isobar-dds.service "$folder/isobard.service" && echo yes)"
check "isobar-dds shares /tmp with isobard" "$(grep -qx JoinsNamespaceOf=isobard.service "$folder/isobar-dds.service" && echo yes)"
exit $failed
