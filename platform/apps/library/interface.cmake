# What a program that links Glint is compiled with: the folders of the headers, C++20, and the options
# that equal bits need. Nothing else of Glint's own options reaches it.
#
# Glint's headers include each other as "kernels/..", a program includes them as <glint/kernels/..>:
# so two folders are named, and a header has the same path in both. A project that adds Glint's folder
# finds them by links, laid out as an installation lays out the files.
set(GLINT_HEADERS ${PROJECT_SOURCE_DIR})
set(GLINT_LINKED_HEADERS ${PROJECT_BINARY_DIR}/include)
file(CONFIGURE OUTPUT ${GLINT_LINKED_HEADERS}/glint/version.hpp @ONLY CONTENT [[
// Version of the library, made by CMake.
#pragma once

#define GLINT_VERSION_MAJOR @PROJECT_VERSION_MAJOR@
#define GLINT_VERSION_MINOR @PROJECT_VERSION_MINOR@
#define GLINT_VERSION_PATCH @PROJECT_VERSION_PATCH@
#define GLINT_VERSION "@PROJECT_VERSION@"
]])
if(GLINT_LIBRARY_ONLY)
  foreach(room kernels graph nodes schedules platform)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${room} ${GLINT_LINKED_HEADERS}/glint/${room} SYMBOLIC)
  endforeach()
  set(GLINT_HEADERS ${GLINT_LINKED_HEADERS} ${GLINT_LINKED_HEADERS}/glint)
endif()

add_library(glint_headers INTERFACE)
target_compile_features(glint_headers INTERFACE cxx_std_20)
target_include_directories(glint_headers INTERFACE "$<BUILD_INTERFACE:${GLINT_HEADERS}>"
  $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/glint>)

add_library(glint_arithmetic INTERFACE)
target_compile_options(glint_arithmetic INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
target_compile_definitions(glint_arithmetic INTERFACE EIGEN_DONT_VECTORIZE)
