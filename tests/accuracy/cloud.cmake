# Included by this folder's CMakeLists.txt: what the cloud's kernels make of simulated surfaces.
glint_test(test_smoothing_accuracy smoothing_test.cpp LIBS glint_kernels LABELS accuracy)
