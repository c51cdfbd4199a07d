target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/voxel_grid.cpp
  ${CMAKE_CURRENT_LIST_DIR}/neighbour_grid.cpp ${CMAKE_CURRENT_LIST_DIR}/radius_outlier.cpp
  ${CMAKE_CURRENT_LIST_DIR}/local_surface.cpp ${CMAKE_CURRENT_LIST_DIR}/moving_least_squares.cpp
  ${CMAKE_CURRENT_LIST_DIR}/planes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/plane_sample.cpp ${CMAKE_CURRENT_LIST_DIR}/plane_support.cpp ${CMAKE_CURRENT_LIST_DIR}/snap_to_planes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/depth_points.cpp ${CMAKE_CURRENT_LIST_DIR}/leave_out_capsules.cpp
  ${CMAKE_CURRENT_LIST_DIR}/map_slices.cpp)
