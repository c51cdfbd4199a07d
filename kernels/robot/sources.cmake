target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/forward_kinematics.cpp)
