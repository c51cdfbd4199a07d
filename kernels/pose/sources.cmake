target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/camera_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_table.cpp)
