# SPDX-License-Identifier: BSD-3-Clause
# Writes the source file of core/version.hpp at each build; an unchanged one is left alone, so that nothing is
# compiled or linked anew. Usage: cmake -Dsource=… -Dout=… -Dversion=… -P write_version.cmake
# ISOBAR_COMMIT in the environment replaces git's answer, for builds from an archive.
set(git git -c safe.directory=* -C ${source})
set(commit "$ENV{ISOBAR_COMMIT}")
if(commit STREQUAL "" AND EXISTS ${source}/.git)
  execute_process(COMMAND ${git} rev-parse --short=7 HEAD
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  execute_process(COMMAND ${git} diff-index --quiet HEAD -- RESULT_VARIABLE changed ERROR_QUIET)
  if(commit AND changed EQUAL 1)
    string(APPEND commit "+")
  endif()
endif()
set(text "${version}")
if(commit)
  set(text "${version} (${commit})")
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.cpp.in ${out} @ONLY)
