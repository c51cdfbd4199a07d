# Included by this folder's CMakeLists.txt: what the cloud's kernels make of simulated surfaces.
glint_test(test_smoothing_accuracy smoothing_test.cpp LIBS glint_kernels LABELS accuracy)
# And a robot found by its exported points; a probe by its points; two halves of a map.
if(NOT GLINT_BOARD_ONLY)
  glint_test(glint_accuracy_test probe_points_test.cpp robot_cloud_test.cpp
    ../unit/platform/tools/mapping/map_halves_test.cpp
    LIBS glint_experiments glint_mapping glint_session glint_tools LABELS accuracy)
endif()
