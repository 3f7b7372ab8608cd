# SPDX-License-Identifier: BSD-3-Clause
# isobar_version: core/version.hpp as a library of one small file, the only one that a new commit rebuilds. Only
# programs link it.
set(isobar_version_file ${CMAKE_BINARY_DIR}/version/version.cpp)
add_custom_target(isobar_version_text
  BYPRODUCTS ${isobar_version_file}
  COMMAND ${CMAKE_COMMAND} -Dsource=${CMAKE_SOURCE_DIR} -Dout=${isobar_version_file} -Dversion=${PROJECT_VERSION}
          -P ${CMAKE_SOURCE_DIR}/tools/cmake/write_version.cmake
  COMMENT "" VERBATIM)
add_library(isobar_version STATIC ${isobar_version_file})
target_include_directories(isobar_version PUBLIC ${CMAKE_SOURCE_DIR})
add_dependencies(isobar_version isobar_version_text)
