# SPDX-License-Identifier: BSD-3-Clause
# Part of `cmake --install`: units, files of udev, sysusers and tmpfiles, and /etc/isobar. A script, because their
# places and the paths in the units follow the prefix of the installation: with /usr they are /lib and /etc, else
# below the prefix, where systemd and udev look too.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(lib /lib)
  set(etc /etc)
else()
  set(lib ${CMAKE_INSTALL_PREFIX}/lib)
  set(etc ${CMAKE_INSTALL_PREFIX}/etc)
endif()
set(systemd ${isobar_source}/systemd)
set(rights OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)

foreach(unit isobard.service isobar-dds.service isobar-metrics.service isobar-web.service run-isobar.mount)
  file(READ ${systemd}/${unit} text)
  string(REPLACE "/etc/isobar/" "${etc}/isobar/" text "${text}")
  string(REPLACE "/usr/" "${CMAKE_INSTALL_PREFIX}/" text "${text}")
  file(WRITE "$ENV{DESTDIR}${lib}/systemd/system/${unit}" "${text}")
  file(CHMOD "$ENV{DESTDIR}${lib}/systemd/system/${unit}" PERMISSIONS ${rights})
  list(APPEND CMAKE_INSTALL_MANIFEST_FILES ${lib}/systemd/system/${unit})
endforeach()
# file(INSTALL) puts DESTDIR before these places itself.
foreach(unit isobard isobar-dds isobar-metrics isobar-web)
  file(INSTALL ${systemd}/shared-memory.conf DESTINATION ${lib}/systemd/system/${unit}.service.d PERMISSIONS ${rights})
endforeach()
file(INSTALL ${systemd}/59-isobar.rules DESTINATION ${lib}/udev/rules.d PERMISSIONS ${rights})
file(INSTALL ${systemd}/isobar.sysusers DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/sysusers.d PERMISSIONS ${rights}
     RENAME isobar.conf)
file(INSTALL ${systemd}/isobar.tmpfiles DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/tmpfiles.d PERMISSIONS ${rights}
     RENAME isobar.conf)

file(INSTALL DESTINATION ${etc}/isobar/conf.d TYPE DIRECTORY FILES "")
if(EXISTS "$ENV{DESTDIR}${etc}/isobar/isobar.toml")
  message("-- Kept: $ENV{DESTDIR}${etc}/isobar/isobar.toml")
else()
  file(INSTALL ${isobar_source}/packaging/isobar.toml DESTINATION ${etc}/isobar PERMISSIONS ${rights})
endif()
