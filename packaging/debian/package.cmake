# SPDX-License-Identifier: BSD-3-Clause
# The Debian package, by CPack: `tools/package`.
set(debian ${CMAKE_CURRENT_LIST_DIR})
set(work ${CMAKE_CURRENT_BINARY_DIR}/debian)
file(MAKE_DIRECTORY ${work})

# Licence text as the field of a copyright file: indented, an empty line as a point.
file(READ ${CMAKE_SOURCE_DIR}/LICENSE licence)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)" _ "${licence}")
set(holder "${CMAKE_MATCH_1}")
string(FIND "${licence}" "Redistribution" begin)
string(SUBSTRING "${licence}" ${begin} -1 text)
string(STRIP "${text}" text)
string(REPLACE "\n\n" "\n.\n" text "${text}")
string(REPLACE "\n" "\n " text " ${text}")
configure_file(${debian}/copyright.in ${work}/copyright @ONLY)
install(FILES ${work}/copyright DESTINATION ${doc})

# Changelog and compressed pages, as Debian's policy wants them; only in the package.
configure_file(${debian}/package_files.cmake.in ${work}/package_files.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${work}/package_files.cmake)

set(CPACK_GENERATOR DEB)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_NAME isobar)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Isobar <isobar@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "lidar localisation whose height comes from air pressure")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"isobard tells a robot where it is in three dimensions: it registers lidar
scans to a growing map, with roll and pitch from gravity and the height from
air pressure, measured against a static base station.
isobar-dds publishes poses, map and diagnostics as a ROS 2 node, without a
ROS installation; isobar simulates, replays, evaluates and calibrates.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "init-system-helpers (>= 1.52), systemd | systemd-standalone-sysusers, systemd | systemd-standalone-tmpfiles")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${debian}/conffiles ${debian}/postinst ${debian}/prerm ${debian}/postrm)
include(CPack)
