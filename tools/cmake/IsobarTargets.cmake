# SPDX-License-Identifier: BSD-3-Clause
# One way to declare a library, a program and a test, so that warnings and sanitizers are the same everywhere.

option(ISOBAR_UNITY "Compile the files of a target together" ON)
option(ISOBAR_PCH "Precompile the common headers" ON)

# isobar_options: what every target is compiled with. isobar_warnings: the same without sanitizers.
add_library(isobar_warnings INTERFACE)
target_compile_options(isobar_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wformat=2 -Werror)
target_include_directories(isobar_warnings INTERFACE ${CMAKE_SOURCE_DIR})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 warns falsely inside Eigen and fmt at -O2.
  target_compile_options(isobar_warnings INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow)
  # Unity: a .cpp that is included counts as a header, whose types may not use an anonymous namespace.
  target_compile_options(isobar_warnings INTERFACE $<$<BOOL:${ISOBAR_UNITY}>:-Wno-subobject-linkage>)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_options(isobar_warnings INTERFACE -Wreserved-identifier)
endif()

add_library(isobar_options INTERFACE)
target_link_libraries(isobar_options INTERFACE isobar_warnings)
if(ISOBAR_SANITIZE)
  target_compile_options(isobar_options INTERFACE -fsanitize=${ISOBAR_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(isobar_options INTERFACE -fsanitize=${ISOBAR_SANITIZE})
  if(ISOBAR_SANITIZE MATCHES "undefined")
    target_compile_options(isobar_options INTERFACE -fno-sanitize-recover=all)
    target_compile_definitions(isobar_options INTERFACE _GLIBCXX_ASSERTIONS)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
      target_compile_options(isobar_options INTERFACE -fsanitize-ignorelist=${CMAKE_SOURCE_DIR}/tools/ubsan.ignore)
    endif()
  endif()
  if(ISOBAR_SANITIZE STREQUAL "thread")
    target_compile_options(isobar_options INTERFACE -Wno-tsan)
  endif()
endif()

# Unity builds and precompiled headers: without them, two thirds of a cold build's time went into headers
# (Eigen, iceoryx, the standard library) that every file parsed again. Unity: files of a target are compiled
# together, in batches (see isobar_compile). Precompiled headers: common headers are parsed once per build
# tree. Both hide missing includes, which `tools/includes` finds.
set(isobar_common_headers <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <fstream> <functional> <memory>
  <optional> <sstream> <string> <string_view> <vector> <Eigen/Core> <Eigen/Geometry>)
function(isobar_precompiled name)  # isobar_precompiled(NAME HEADER…): precompiled headers for isobar_compile()
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

# Coverage counters, by which libFuzzer finds its way, in the code that reads bytes from outside. Elsewhere they would
# halve the speed of the tests.
set(isobar_fuzz_coverage -fsanitize=fuzzer-no-link)

# isobar_compile(TARGET PCH UNITY): precompiled headers and unity batch of a target. UNITY: files per batch,
# 0: all, 1: each file alone. Batches of a library are small, so that a changed file is rebuilt in seconds.
function(isobar_compile target pch unity)
  if(ISOBAR_UNITY AND NOT unity EQUAL 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${unity})
  endif()
  if(ISOBAR_PCH)
    target_precompile_headers(${target} REUSE_FROM ${pch})
  endif()
endfunction()

# isobar_library(NAME DEPENDS lib… [UNITY n]): static library of every .cpp in the current folder (not below
# it).
# OWN_FLAGS: for a library with compile options of its own, to which a shared precompiled header does not fit.
# TOOL_ONLY: code that never runs on a robot (simulator, report). Sanitizer builds compile it without
# sanitizers, because its checks took half of their time.
function(isobar_library name)
  cmake_parse_arguments(arg "OWN_FLAGS;TOOL_ONLY" "UNITY" "DEPENDS;PRIVATE_DEPENDS;SOURCES" ${ARGN})
  if(NOT DEFINED arg_UNITY)
    set(arg_UNITY 8)
  endif()
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  endif()
  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    target_link_libraries(${name} PUBLIC Eigen3::Eigen ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS})
    target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
    set(options isobar_options)
    if(arg_TOOL_ONLY AND ISOBAR_SANITIZE)
      set(options isobar_warnings)
      target_compile_options(${name} PRIVATE -O2)
      set(arg_OWN_FLAGS ON)
    endif()
    target_link_libraries(${name} PRIVATE ${options})
    set(pch isobar_common_pch)
    file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    if(ISOBAR_FUZZ AND folder MATCHES "^(drivers|run|config)/|^tools/web$" AND NOT arg_TOOL_ONLY)
      target_compile_options(${name} PRIVATE ${isobar_fuzz_coverage})
      set(pch isobar_fuzzed_pch)
    endif()
    if(arg_OWN_FLAGS)
      set_target_properties(${name} PROPERTIES UNITY_BUILD ${ISOBAR_UNITY} UNITY_BUILD_BATCH_SIZE ${arg_UNITY})
    else()
      isobar_compile(${name} ${pch} ${arg_UNITY})
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE Eigen3::Eigen ${arg_DEPENDS})
    target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
  endif()
endfunction()

# lld links a test in a tenth of the time of GNU ld. Programs keep GNU ld, because lld 14 does not write the
# ISA note.
find_program(ISOBAR_LLD ld.lld)
function(isobar_link_fast target)
  if(ISOBAR_LLD)
    target_link_options(${target} PRIVATE -fuse-ld=lld)
  endif()
endfunction()

# isobar_program(NAME SOURCES … DEPENDS …)
function(isobar_program name)
  cmake_parse_arguments(arg "" "" "DEPENDS;SOURCES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE isobar_options ${arg_DEPENDS})
  isobar_compile(${name} isobar_common_pch 8)
  if(ISOBAR_CPU MATCHES "^x86-64-v[234]$")
    # ISA note: on an older machine the loader refuses the program with a message, instead of an illegal
    # instruction later.
    target_link_options(${name} PRIVATE LINKER:-z,${ISOBAR_CPU})
  endif()
endfunction()

# isobar_test(NAME LABEL unit|integration COST … SOURCES … DEPENDS …): one doctest program, one CTest entry.
# COST: duration of a long test under AddressSanitizer [s]; CTest starts the longest ones first.
# main() is in tests/test_main.cpp, compiled once for all tests.
function(isobar_test name)
  cmake_parse_arguments(arg "" "LABEL;COST;UNITY" "DEPENDS;SOURCES" ${ARGN})
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
  if(NOT DEFINED arg_UNITY)
    set(arg_UNITY 8)
  endif()
  isobar_compile(${name} isobar_test_pch ${arg_UNITY})
  isobar_link_fast(${name})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL} TIMEOUT 900 ${cost})
endfunction()

# isobar_has_threads(NAME…): marks tests of this folder with a second thread or process, which ThreadSanitizer
# is to check, by the label `threads`; the target thread_tests builds them.
add_custom_target(thread_tests)
function(isobar_has_threads)
  foreach(name ${ARGN})
    set_property(TEST ${name} APPEND PROPERTY LABELS threads)
    if(TARGET ${name})
      add_dependencies(thread_tests ${name})
    endif()
  endforeach()
endfunction()
