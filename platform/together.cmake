# Several files compiled as one read their headers once. CMAKE_UNITY_BUILD does it to every target,
# GLINT_TOGETHER to tests and commands alone: what is measured keeps its machine code.
set(GLINT_TOGETHER_OPTIONS "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # takes such a file for a header
  set(GLINT_TOGETHER_OPTIONS $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
endif()
if(CMAKE_UNITY_BUILD)
  add_compile_options(${GLINT_TOGETHER_OPTIONS})
endif()

function(glint_together target)
  if(GLINT_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
    target_compile_options(${target} PRIVATE ${GLINT_TOGETHER_OPTIONS})
  endif()
endfunction()
