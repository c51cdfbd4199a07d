# Made of observed costs on a desktop; the board never needs it.
add_library(glint_envelope STATIC ${CMAKE_CURRENT_LIST_DIR}/envelope.cpp)
target_link_libraries(glint_envelope PUBLIC glint_graph)
