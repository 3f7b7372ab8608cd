# SPDX-License-Identifier: BSD-3-Clause
# One way to declare a library, a program and a test, so that warnings and sanitizers are the same everywhere.

add_library(isobar_options INTERFACE)
target_compile_options(isobar_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wformat=2 -Werror)
target_include_directories(isobar_options INTERFACE ${CMAKE_SOURCE_DIR})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 warns falsely inside Eigen and fmt at -O2.
  target_compile_options(isobar_options INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_options(isobar_options INTERFACE -Wreserved-identifier)
endif()
if(ISOBAR_SANITIZE)
  target_compile_options(isobar_options INTERFACE -fsanitize=${ISOBAR_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(isobar_options INTERFACE -fsanitize=${ISOBAR_SANITIZE})
  if(ISOBAR_SANITIZE MATCHES "undefined")
    target_compile_options(isobar_options INTERFACE -fno-sanitize-recover=all)
  endif()
  if(ISOBAR_SANITIZE STREQUAL "thread")
    target_compile_options(isobar_options INTERFACE -Wno-tsan)
  endif()
endif()
if(ISOBAR_FUZZ)
  target_compile_options(isobar_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# With ISOBAR_PCH the headers that nearly every file includes are compiled once a build tree. The sanitizers' presets do
# it; the release preset does not, so that a file that forgets an include fails there.
option(ISOBAR_PCH "Precompile the common headers" OFF)
set(isobar_common_headers <algorithm> <array> <cmath> <cstdint> <filesystem> <memory> <optional> <string> <vector>
  <Eigen/Core> <Eigen/Geometry>)
function(isobar_precompiled name)  # isobar_precompiled(NAME HEADERS …): makes them, for isobar_use_precompiled()
  if(NOT ISOBAR_PCH)
    return()
  endif()
  file(WRITE ${CMAKE_BINARY_DIR}/${name}.cpp "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE isobar_options Eigen3::Eigen)
  target_precompile_headers(${name} PRIVATE ${ARGN})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(${name} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")  # for ccache
  endif()
endfunction()
function(isobar_use_precompiled target name)
  if(ISOBAR_PCH)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

# isobar_library(NAME DEPENDS lib…): static library of every .cpp in the current folder (not below it).
# PRECOMPILED names headers that all its files include and that are worth it in every build.
function(isobar_library name)
  cmake_parse_arguments(arg "" "" "DEPENDS;PRIVATE_DEPENDS;SOURCES;PRECOMPILED" ${ARGN})
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  endif()
  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    target_link_libraries(${name} PUBLIC Eigen3::Eigen ${arg_DEPENDS} PRIVATE isobar_options ${arg_PRIVATE_DEPENDS})
    target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
    if(arg_PRECOMPILED)
      target_precompile_headers(${name} PRIVATE ${arg_PRECOMPILED})
    else()
      isobar_use_precompiled(${name} isobar_common_pch)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE Eigen3::Eigen ${arg_DEPENDS})
    target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
  endif()
endfunction()

# isobar_program(NAME SOURCES … DEPENDS …)
function(isobar_program name)
  cmake_parse_arguments(arg "" "" "DEPENDS;SOURCES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE isobar_options ${arg_DEPENDS})
endfunction()

# isobar_test(NAME LABEL unit|integration COST … SOURCES … DEPENDS …): one doctest program, one CTest entry.
# COST: seconds under AddressSanitizer, where it is many; the longest ones start first.
# The sources name no main(); tests/test_main.cpp has the only one, compiled once.
function(isobar_test name)
  cmake_parse_arguments(arg "" "LABEL;COST" "DEPENDS;SOURCES" ${ARGN})
  if(arg_COST)
    set(cost COST ${arg_COST})
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE isobar_options isobar_test_main Eigen3::Eigen ${arg_DEPENDS})
  target_compile_definitions(${name} PRIVATE
    ISOBAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}" ISOBAR_SHARED_DATA="${CMAKE_SOURCE_DIR}/../shared/data")
  isobar_use_precompiled(${name} isobar_test_pch)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL} TIMEOUT 900 ${cost})
endfunction()

# isobar_has_threads(NAME …): tests of this folder with a second thread or process. They carry the label `threads`,
# and the target thread_tests builds them: the ones that ThreadSanitizer has something to say about.
add_custom_target(thread_tests)
function(isobar_has_threads)
  foreach(name ${ARGN})
    set_property(TEST ${name} APPEND PROPERTY LABELS threads)
    if(TARGET ${name})
      add_dependencies(thread_tests ${name})
    endif()
  endforeach()
endfunction()
