# SPDX-License-Identifier: BSD-3-Clause
# Progress of a long step, for scripts to source: on a terminal one line that is redrawn every second, in a
# pipe a line every ten seconds.

# Percentage of ninja edges that are done, from a build log written with NINJA_STATUS='[%f/%t] '.
percent_of_build() {
  grep -o '^\[[0-9]*/[0-9]*\]' "$1" | tail -n 1 | tr -d '[]' | awk -F/ '{ print int(100 * $1 / $2) }'
}

# follow_progress LABEL PERCENT_FUNCTION LOG COMMAND…: runs COMMAND with its output in LOG. Until it ends,
# prints LABEL and the percentage that PERCENT_FUNCTION reads from LOG. Returns COMMAND's exit code.
follow_progress() {
  local label=$1 percent_of=$2 log=$3 seconds=0 interval=10 percent pid
  shift 3
  [ -t 1 ] && interval=1
  : >"$log"
  "$@" >>"$log" 2>&1 &
  pid=$!
  while kill -0 "$pid" 2>/dev/null; do
    if [ $((seconds % interval)) -eq 0 ]; then
      percent=$("$percent_of" "$log")
      if [ -t 1 ]; then printf '\r\033[K     %s: %3d %%' "$label" "${percent:-0}"
      else printf '     %s: %d %% (%d s)\n' "$label" "${percent:-0}" "$seconds"; fi
    fi
    sleep 1
    seconds=$((seconds + 1))
  done
  [ -t 1 ] && printf '\r\033[K'
  wait "$pid"
}
