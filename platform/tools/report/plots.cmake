add_library(glint_plots STATIC statistics.cpp svg.cpp axes.cpp plots.cpp)
target_link_libraries(glint_plots PUBLIC Eigen3::Eigen)
