target_sources(glint_registration PRIVATE ${CMAKE_CURRENT_LIST_DIR}/align_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/alignment_scratch.cpp ${CMAKE_CURRENT_LIST_DIR}/alignment_sums.cpp
  ${CMAKE_CURRENT_LIST_DIR}/follow_reference.cpp ${CMAKE_CURRENT_LIST_DIR}/judge_alignment.cpp
  ${CMAKE_CURRENT_LIST_DIR}/judge_links.cpp ${CMAKE_CURRENT_LIST_DIR}/match_points.cpp
  ${CMAKE_CURRENT_LIST_DIR}/model_cloud.cpp ${CMAKE_CURRENT_LIST_DIR}/outline.cpp
  ${CMAKE_CURRENT_LIST_DIR}/patch_covariance.cpp ${CMAKE_CURRENT_LIST_DIR}/point_grid.cpp
  ${CMAKE_CURRENT_LIST_DIR}/render_depth.cpp ${CMAKE_CURRENT_LIST_DIR}/visible_points.cpp
  ${CMAKE_CURRENT_LIST_DIR}/shared_errors.cpp ${CMAKE_CURRENT_LIST_DIR}/splat_cloud.cpp)
