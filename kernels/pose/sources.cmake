target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/camera_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_table.cpp ${CMAKE_CURRENT_LIST_DIR}/local_rays.cpp
  ${CMAKE_CURRENT_LIST_DIR}/back_project.cpp)
target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/tool.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rigid_fit.cpp ${CMAKE_CURRENT_LIST_DIR}/candidates.cpp
  ${CMAKE_CURRENT_LIST_DIR}/correspond.cpp ${CMAKE_CURRENT_LIST_DIR}/assign.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fit_covariance.cpp)
