# The board files of schedules/boards, as texts in a header: `--board NAME` needs no path.
file(GLOB boards CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/schedules/boards/*.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${boards})
set(rows "")
foreach(board ${boards})
  cmake_path(GET board STEM LAST_ONLY name)
  file(READ ${board} text)
  string(APPEND rows "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
list(LENGTH boards count)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/include/glint_built_in_boards.hpp @ONLY CONTENT
"// Made by CMake from schedules/boards.
#pragma once

#include <array>
#include <string_view>

namespace glint {

struct BuiltInBoard {
  std::string_view name, text;
};
inline constexpr std::array<BuiltInBoard, @count@> k_built_in_boards = {{
@rows@}};

}  // namespace glint
")
