# GLINT_PRECOMPILE: Eigen, GoogleTest and the standard library are a fifth to a half of what most
# files take to compile; here they are read once, in three variants: small and without exceptions for
# the core, with them, and with GoogleTest beside it. The machine code stays the same. What only few
# files use stays out: g++ instantiates what a precompiled header does not need anew in every file
# (nlohmann-json: half a second each).
# The compiler does not report a file that lacks an include: tests/check_includes does, and the debug
# preset compiles each file by itself, without these headers.
find_package(GTest QUIET)
file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "")
set(core_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <optional> <span>)
set(headers ${core_headers} <atomic> <chrono> <filesystem> <fstream> <functional> <map> <memory>
  <random> <sstream> <string> <thread> <vector>)
foreach(variant precompiled precompiled_core precompiled_tests)
  add_library(glint_${variant} OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(glint_${variant} PRIVATE Eigen3::Eigen)
  if(GLINT_PRECOMPILED_LAUNCHER)
    set_target_properties(glint_${variant} PROPERTIES
      CXX_COMPILER_LAUNCHER "${GLINT_PRECOMPILED_LAUNCHER}")
  endif()
endforeach()
target_precompile_headers(glint_precompiled_core PRIVATE ${core_headers})
target_link_libraries(glint_precompiled_core PRIVATE glint_core_flags)
foreach(variant precompiled precompiled_tests)
  target_precompile_headers(glint_${variant} PRIVATE ${headers})
endforeach()
if(GLINT_SANITIZE)  # as most of the platform (platform/CMakeLists.txt)
  target_compile_options(glint_precompiled PRIVATE -O0)
endif()
if(GTest_FOUND)
  target_link_libraries(glint_precompiled_tests PRIVATE GTest::gtest)
  get_property(test_options DIRECTORY ${CMAKE_SOURCE_DIR}/tests PROPERTY GLINT_TEST_OPTIONS)
  target_compile_options(glint_precompiled_tests PRIVATE ${test_options})
  target_precompile_headers(glint_precompiled_tests PRIVATE <gtest/gtest.h>)
endif()

function(glint_precompile)
  glint_targets_below(${CMAKE_SOURCE_DIR} targets)
  list(FILTER targets EXCLUDE REGEX "^glint_precompiled")
  foreach(target ${targets})
    get_target_property(sources ${target} SOURCES)
    get_target_property(options ${target} COMPILE_OPTIONS)
    if(sources MATCHES "\\.c(;|$)")
      continue()
    endif()
    get_target_property(links ${target} LINK_LIBRARIES)
    if("glint_core_flags" IN_LIST links)
      set(variant glint_precompiled_core)
    elseif("GTest::gtest_main" IN_LIST links)
      set(variant glint_precompiled_tests)
    else()
      set(variant glint_precompiled)
    endif()
    get_target_property(common ${variant} COMPILE_OPTIONS)
    foreach(list options common)  # a warning, and what code is made: neither changes what was read
      list(REMOVE_ITEM ${list} "${GLINT_TOGETHER_OPTIONS}" "${GLINT_COVERAGE_OPTIONS}"
        ${GLINT_CALL_GRAPH_OPTIONS})
    endforeach()
    if(options STREQUAL common)  # else some of its own: what was read without them does not hold
      target_precompile_headers(${target} REUSE_FROM ${variant})
    endif()
  endforeach()
endfunction()
glint_precompile()
