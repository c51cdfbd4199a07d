target_sources(glint_kernels PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/roi_threshold.cpp
  ${CMAKE_CURRENT_LIST_DIR}/roi_threshold_reference.cpp
  ${CMAKE_CURRENT_LIST_DIR}/components.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rescan.cpp
  ${CMAKE_CURRENT_LIST_DIR}/centroid.cpp
  ${CMAKE_CURRENT_LIST_DIR}/centroid_variance.cpp
  ${CMAKE_CURRENT_LIST_DIR}/blob_settings.cpp
  ${CMAKE_CURRENT_LIST_DIR}/marker_misfit.cpp
  ${CMAKE_CURRENT_LIST_DIR}/nearest_candidates.cpp
  ${CMAKE_CURRENT_LIST_DIR}/blobs.cpp)
