# One line that names what decides the code: a cost measured under another line is not this build's.
# Directory-wide options count too, so that a sanitizer or a global -march is seen.
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
get_property(options DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY COMPILE_OPTIONS)
get_property(definitions DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY COMPILE_DEFINITIONS)
set(words ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}})
separate_arguments(words)
list(APPEND words ${options})
set(flags "")
foreach(word ${words})
  # Warnings, includes and path maps leave the code as it is; optimisation, machine and semantics
  # do not. Kernels and nodes have no variable of a shared library, whose access one option changes.
  if(word MATCHES "^-(O|m|f|D)" AND NOT word STREQUAL "-mno-direct-extern-access"
      AND NOT word MATCHES "^-f(diagnostics|file-prefix|debug-prefix|macro-prefix)")
    list(APPEND flags ${word})
  endif()
endforeach()
foreach(definition ${definitions})
  list(APPEND flags -D${definition})
endforeach()
list(REMOVE_DUPLICATES flags)
list(JOIN flags " " flags)
set(GLINT_BUILD_SIGNATURE
  "${CMAKE_SYSTEM_PROCESSOR} ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${flags}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_signature.hpp.in
  ${CMAKE_CURRENT_BINARY_DIR}/include/glint_build_signature.hpp @ONLY)
add_library(glint_build_signature INTERFACE)
target_include_directories(glint_build_signature INTERFACE ${CMAKE_CURRENT_BINARY_DIR}/include)
