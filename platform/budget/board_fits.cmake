# -DGLINT_BOARD=none|NAME|FILE: a build for a board asserts that the chains fit on it. `none` builds
# unchecked, so that measuring can begin.
set(GLINT_BOARD none CACHE STRING "Board that the chains must fit on: none, a name or a board file")
add_executable(glint_board_header board_header_main.cpp)
target_link_libraries(glint_board_header PRIVATE glint_board_file)
if(NOT GLINT_BOARD STREQUAL "none")
  set(board_file ${CMAKE_SOURCE_DIR}/schedules/boards/${GLINT_BOARD}.toml)
  if(NOT EXISTS ${board_file})
    cmake_path(ABSOLUTE_PATH GLINT_BOARD BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE board_file)
  endif()
  set(header ${CMAKE_CURRENT_BINARY_DIR}/include/glint_board_costs.hpp)
  add_custom_command(OUTPUT ${header} COMMAND glint_board_header ${board_file} ${header}
    DEPENDS ${board_file} glint_board_header VERBATIM)
  add_library(glint_board_fits STATIC board_fits.cpp ${header})
  target_include_directories(glint_board_fits PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/include)
  target_link_libraries(glint_board_fits PRIVATE glint_nodes)
endif()
