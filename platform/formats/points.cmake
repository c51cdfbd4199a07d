add_library(glint_points STATIC points_csv.cpp)
target_link_libraries(glint_points PUBLIC glint_kernels)
