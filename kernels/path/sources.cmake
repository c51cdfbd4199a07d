target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/resample_stroke.cpp
  ${CMAKE_CURRENT_LIST_DIR}/smooth_stroke.cpp)
