set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS tools/pen.toml tools/board.toml)
file(READ tools/pen.toml GLINT_PEN)
file(READ tools/board.toml GLINT_BOARD)
configure_file(built_in_tools.hpp.in ${CMAKE_CURRENT_BINARY_DIR}/tools/glint_built_in_tools.hpp @ONLY)

add_library(glint_tool_files STATIC depth_bias_table.cpp tool_file.cpp tool_toml.cpp tool_rom.cpp tool_ini.cpp tool_writer.cpp)
target_include_directories(glint_tool_files PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/tools)
target_link_libraries(glint_tool_files PUBLIC glint_kernels glint_toml)
