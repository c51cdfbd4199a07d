# Included by this folder's CMakeLists.txt: what the cloud's kernels make of simulated surfaces.
glint_test(test_smoothing_accuracy smoothing_test.cpp LIBS glint_kernels LABELS accuracy)
# And a robot found by its exported points.
if(NOT GLINT_BOARD_ONLY)
  glint_test(test_robot_cloud_accuracy robot_cloud_test.cpp LIBS glint_experiments LABELS accuracy)
endif()
