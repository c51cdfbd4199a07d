# CMAKE_UNITY_BUILD: a few files of a target are compiled as one, so that what they include is read
# and instantiated once for all of them. Files that give different things the same name, as each may
# in its unnamed namespace, are kept apart here: nobody has to invent names that no neighbour has.
# What is measured, counted or timed stays file by file: CMAKE_UNITY_BUILD is OFF in its folder. So
# is the debug preset, and -DCMAKE_UNITY_BUILD=OFF serves whoever edits one file again and again.
# Where a new name gives "redefinition" in a build folder that is older, configure it again.
set(files_together 8)  # more would be one long file at the end, on which every core waits

# What a file defines: constants anywhere, types, functions and variables at the start of a line.
function(glint_defined_names file result)
  file(READ ${file} text)
  string(REGEX REPLACE "[][;]" "#" text "${text}")  # what CMake's lists would stumble over
  string(REGEX MATCHALL "k_[a-z0-9_]+(#[^\n=]*#)? *[={]" constants "${text}")
  string(REGEX MATCHALL "\n(struct|class|enum class|using) [A-Za-z0-9_]+" types "${text}")
  string(REGEX MATCHALL "\n[A-Za-z#][A-Za-z0-9_:<>,*&# ]*[ *&][a-z0-9_]+ *[(=]" functions "${text}")
  list(TRANSFORM constants REPLACE "^(k_[a-z0-9_]+).*" "\\1")
  set(names ${constants} ${types} ${functions})
  list(TRANSFORM names REPLACE "^.*[^A-Za-z0-9_]([A-Za-z0-9_]+) *[(=]?$" "\\1")
  list(REMOVE_DUPLICATES names)
  set(${result} "${names}" PARENT_SCOPE)
endfunction()

function(glint_compile_together target)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  set(groups 0)
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder})
    if(NOT source MATCHES "\\.cpp$" OR NOT EXISTS ${source})
      continue()
    endif()
    glint_defined_names(${source} names)
    set(group 0)
    set(placed FALSE)
    while(NOT placed)
      set(shared ${names} ${names_${group}})
      list(LENGTH shared before)
      list(REMOVE_DUPLICATES shared)
      list(LENGTH shared after)
      if(before EQUAL after AND NOT "${count_${group}}" STREQUAL "${files_together}")
        set(placed TRUE)
      else()
        math(EXPR group "${group} + 1")
      endif()
    endwhile()
    set(names_${group} ${shared})
    math(EXPR count_${group} "0${count_${group}} + 1")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES
      UNITY_GROUP together_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()

function(glint_compile_folder_together folder)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(below ${folders})
    glint_compile_folder_together(${below})
  endforeach()
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(together ${target} UNITY_BUILD)
    if(together)
      glint_compile_together(${target})
    endif()
  endforeach()
endfunction()
glint_compile_folder_together(${CMAKE_SOURCE_DIR})
