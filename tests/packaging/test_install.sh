#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `cmake --install`: everything is there, programs run from their new place, pages and completions are free of errors,
# and an edited configuration survives a second installation.
# Usage: test_install.sh SOURCE_FOLDER BUILD_FOLDER
set -euo pipefail
shopt -s extglob nullglob
source=$1
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
failed=0
check() { # check NAME COMMAND…: passes when COMMAND succeeds and prints nothing
  local name=$1 said
  shift
  if said=$("$@" 2>&1) && [ -z "$said" ]; then echo "ok: $name"; else echo "FAILED: $name: $said"; failed=1; fi
}
install() { DESTDIR=$root cmake --install "$2" --prefix "$1" >"$root/log" || { cat "$root/log"; exit 1; }; }

install /usr "$2"
for file in usr/bin/{isobard,isobar,isobar-dds} lib/systemd/system/{isobard.service,isobar-dds.service,isobar-metrics.service,isobar-web.service,run-isobar.mount} \
  lib/systemd/system/{isobard,isobar-dds,isobar-metrics,isobar-web}.service.d/shared-memory.conf \
  lib/udev/rules.d/59-isobar.rules usr/lib/sysusers.d/isobar.conf usr/lib/tmpfiles.d/isobar.conf etc/isobar/isobar.toml \
  etc/isobar/conf.d usr/share/man/man8/{isobard,isobar-dds}.8 usr/share/man/man5/isobar.toml.5 \
  usr/share/doc/isobar/copyright usr/share/isobar/ros2/isobar_msgs/package.xml; do
  check "installed: $file" test -e "$root/$file"
done

isobar=$root/usr/bin/isobar
commit=$(git -c safe.directory='*' -C "$source" rev-parse --short=7 HEAD 2>/dev/null || true)
for program in isobard isobar isobar-dds; do
  check "$program --version names the commit" grep -Eqx "$program [0-9.]+( \(${commit:-.*}\+?\))?" \
    <("$root/usr/bin/$program" --version)
  check "man page of $program" test -e "$root/usr/share/man/man$([ $program = isobar ] && echo 1 || echo 8)/$program".?
done
# The first word of each line below "Subcommands:".
commands=$("$isobar" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
check "isobar --help lists subcommands" test -n "$commands"
for command in $commands; do
  check "page of isobar $command" test -e "$root/usr/share/man/man1/isobar-$command.1"
done
while read -r key; do
  check "isobar.toml(5) explains $key" grep -qF "fB${key//-/\\-} = " "$root/usr/share/man/man5/isobar.toml.5"
done < <("$isobar" config show | sed -n 's/^\([a-z][a-z0-9_.]*\) = .*/\1/p')
if command -v man >/dev/null; then
  for page in "$root"/usr/share/man/man?/*; do
    check "no warnings in ${page##*/}" bash -c 'LC_ALL=C.UTF-8 man --warnings -E UTF-8 -l -Tutf8 -Z "$1" 2>&1 >/dev/null' _ "$page"
  done
fi
for file in "$root"/usr/share/bash-completion/completions/*; do check "bash reads ${file##*/}" bash -n "$file"; done
for shell in zsh fish; do
  command -v $shell >/dev/null || continue
  for file in "$root"/usr/share/$shell/vendor?completions?(.d)/*; do check "$shell reads ${file##*/}" $shell -n "$file"; done
done
complete() { # complete WORD…: what bash offers for the last word
  bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _isobar; echo "${COMPREPLY[*]}"' _ \
    "$root/usr/share/bash-completion/completions/isobar" "$@"
}
check "bash completes a command" test "$(complete isobar sim)" = simulate
check "bash completes a command of a command" test "$(complete isobar map exp)" = export
check "bash completes the value of an option" test "$(complete isobar evaluate --align r)" = rigid

for file in "$root"/etc/isobar/isobar.toml "$root"/usr/share/doc/isobar/examples/*.toml; do
  check "isobar config check ${file##*/}" bash -c '"$1" config check "$2" >/dev/null' _ "$isobar" "$file"
done
check "the packaged configuration is short" test "$(grep -cv '^\(#.*\)\?$' "$root/etc/isobar/isobar.toml")" -le 12

echo "# mine" >>"$root/etc/isobar/isobar.toml"
install /usr "$2"
check "a second installation keeps the configuration" grep -qx "# mine" "$root/etc/isobar/isobar.toml"
install /opt/isobar "$2"
check "another prefix: the unit starts that program with that configuration" \
  grep -qx "ExecStart=/opt/isobar/bin/isobard --config /opt/isobar/etc/isobar/isobar.toml" \
  "$root/opt/isobar/lib/systemd/system/isobard.service"
for script in postinst prerm postrm; do
  check "$script of the package names every optional unit" bash -c \
    'grep -q isobar-metrics.service "$1" && grep -q isobar-web.service "$1"' _ "$source/packaging/debian/$script"
done
check "the page is not enabled by the package" bash -c '! grep -q "enable .*isobar-web" "$1"' _ "$source/packaging/debian/postinst"
exit $failed
