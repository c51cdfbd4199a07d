# cmake -DCOMPILER=g++ -DROOT=dir -DFILE=case.cpp -P expect_failure.cmake
# Passes if the compiler refuses the file and prints what its first line expects:
#   // expect: REGULAR EXPRESSION      or      // expect: success
file(STRINGS ${FILE} first LIMIT_COUNT 1)
if(NOT first MATCHES "^// expect: (.+)$")
  message(FATAL_ERROR "${FILE}:1: no line of the form '// expect: REGULAR EXPRESSION'")
endif()
set(expected "${CMAKE_MATCH_1}")

execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -I${ROOT} ${FILE}
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(expected STREQUAL "success")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${FILE} should compile:\n${output}")
  endif()
elseif(status EQUAL 0)
  message(FATAL_ERROR "${FILE} compiles, but should not: ${expected}")
elseif(NOT output MATCHES "${expected}")
  message(FATAL_ERROR "${FILE} is refused without naming '${expected}':\n${output}")
endif()
