# Compiling through ccache, so that a fresh clone of the same commit compiles nothing again. Paths
# inside the tree are made relative before they are hashed, debug information holds none of them,
# and no preset depends on the folder that it is built in.
find_program(GLINT_CCACHE ccache)
if(GLINT_CCACHE)
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=true
    CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_PCH_EXTSUM=true CCACHE_DEPEND=true
    CCACHE_EXTRAFILES=${CMAKE_SOURCE_DIR}/tests/unsanitized.txt ${GLINT_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  # Files compiled as one are included by their whole path: GoogleTest's __FILE__ would hold it.
  add_compile_options(-ffile-prefix-map=${CMAKE_SOURCE_DIR}/=)
  # ccache compares the sum beside a precompiled header, not its 100 MB. Clang stores whole paths in
  # it: it is made without the cache, and named by an option whose path ccache makes relative.
  set(GLINT_PRECOMPILED_LAUNCHER ${CMAKE_SOURCE_DIR}/platform/with_sum ${CMAKE_SOURCE_DIR})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(CMAKE_CXX_COMPILE_OPTIONS_USE_PCH -include-pch <PCH_FILE>)
  else()
    list(APPEND GLINT_PRECOMPILED_LAUNCHER ${launcher})
  endif()
endif()

# For a target whose call graph is read. ccache stores the account of the stack beside an object, but
# not the call graph, so that takes its place.
set(GLINT_CALL_GRAPH_OPTIONS -fstack-usage -fcallgraph-info=su,da)
set(GLINT_CALL_GRAPH_LAUNCHER ${CMAKE_SOURCE_DIR}/tests/footprint/with_call_graph)
if(GLINT_CCACHE)
  set(GLINT_CALL_GRAPH_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_PREFIX=${GLINT_CALL_GRAPH_LAUNCHER}
    ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
