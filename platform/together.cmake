# Several files compiled as one read their headers once. CMAKE_UNITY_BUILD does it to every target;
# GLINT_TOGETHER to the platform and the tests: the core's files keep the machine code whose cost
# was measured.
set(GLINT_TOGETHER_OPTIONS "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # takes such a file for a header
  set(GLINT_TOGETHER_OPTIONS $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
if(CMAKE_UNITY_BUILD)
  add_compile_options(${GLINT_TOGETHER_OPTIONS})
endif()

# For the targets that follow in this folder and below.
macro(glint_together)
  if(GLINT_TOGETHER AND NOT CMAKE_UNITY_BUILD)
    set(CMAKE_UNITY_BUILD ON)
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
    add_compile_options(${GLINT_TOGETHER_OPTIONS})
  endif()
endmacro()
