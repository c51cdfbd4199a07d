target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/camera_model.cpp
  ${CMAKE_CURRENT_LIST_DIR}/ray_table.cpp ${CMAKE_CURRENT_LIST_DIR}/local_rays.cpp
  ${CMAKE_CURRENT_LIST_DIR}/back_project.cpp
  ${CMAKE_CURRENT_LIST_DIR}/sphere_shift.cpp
  ${CMAKE_CURRENT_LIST_DIR}/depth_samples.cpp
  ${CMAKE_CURRENT_LIST_DIR}/robust_mean.cpp)
target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/tool.cpp
  ${CMAKE_CURRENT_LIST_DIR}/rigid_fit.cpp ${CMAKE_CURRENT_LIST_DIR}/best_rotation.cpp
  ${CMAKE_CURRENT_LIST_DIR}/candidates.cpp
  ${CMAKE_CURRENT_LIST_DIR}/pair_matches.cpp ${CMAKE_CURRENT_LIST_DIR}/labeling_search.cpp
  ${CMAKE_CURRENT_LIST_DIR}/correspond.cpp ${CMAKE_CURRENT_LIST_DIR}/assign.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fit_covariance.cpp ${CMAKE_CURRENT_LIST_DIR}/bias_correction.cpp)
target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/pose_factor.cpp ${CMAKE_CURRENT_LIST_DIR}/lever_arm.cpp
  ${CMAKE_CURRENT_LIST_DIR}/calibration_errors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/weighted_marker.cpp ${CMAKE_CURRENT_LIST_DIR}/marker_sight.cpp
  ${CMAKE_CURRENT_LIST_DIR}/normal_equations.cpp
  ${CMAKE_CURRENT_LIST_DIR}/expected_pose.cpp ${CMAKE_CURRENT_LIST_DIR}/choose_hypothesis.cpp
  ${CMAKE_CURRENT_LIST_DIR}/pose_prior.cpp
  ${CMAKE_CURRENT_LIST_DIR}/weighted_fit.cpp ${CMAKE_CURRENT_LIST_DIR}/map_pose.cpp
  ${CMAKE_CURRENT_LIST_DIR}/depth_flip.cpp ${CMAKE_CURRENT_LIST_DIR}/refine_pose.cpp
  ${CMAKE_CURRENT_LIST_DIR}/decide_labeling.cpp ${CMAKE_CURRENT_LIST_DIR}/partial_visibility.cpp
  ${CMAKE_CURRENT_LIST_DIR}/noise_estimate.cpp
  ${CMAKE_CURRENT_LIST_DIR}/systematic_covariance.cpp)
# These loops read no errno and use no floating-point traps: with either, the compiler would not
# vectorise the pass over all pairs. Neither option changes a result.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/pair_matches.cpp PROPERTIES
  COMPILE_OPTIONS "-fno-math-errno;-fno-trapping-math" SKIP_PRECOMPILE_HEADERS ON)
