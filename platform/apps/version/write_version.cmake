# Writes OUTPUT, the definition of version_text(), if its text changes:
#   cmake -DSOURCE=FOLDER -DVERSION=0.1.0 -DOUTPUT=version.cpp -P write_version.cmake
# The commit is that of SOURCE's own repository: git searches no folder above it, and a hook's
# variables do not redirect git. Without git, or in an unpacked archive, the commit is unknown.
set(commit "commit unknown: git names none")
find_program(GIT git)
if(GIT)
  get_filename_component(above "${SOURCE}" DIRECTORY)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE --unset=GIT_INDEX_FILE
      "GIT_CEILING_DIRECTORIES=${above}" ${GIT} -C "${SOURCE}"
      describe --always --dirty=,\ changed --exclude=* --abbrev=12
    OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE code)
  if(code EQUAL 0)
    set(commit "commit ${described}")
  endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
// Made by write_version.cmake.
#include "platform/apps/version/version.hpp"

namespace glint {

const char* version_text() { return "glint @VERSION@ (@commit@)"; }

}  // namespace glint
]])
