target_sources(glint_kernels PRIVATE ${CMAKE_CURRENT_LIST_DIR}/head_drift_correction.cpp
  ${CMAKE_CURRENT_LIST_DIR}/head_drift.cpp ${CMAKE_CURRENT_LIST_DIR}/world_errors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/interpolate.cpp
  ${CMAKE_CURRENT_LIST_DIR}/motion_filter.cpp ${CMAKE_CURRENT_LIST_DIR}/predict_motion.cpp
  ${CMAKE_CURRENT_LIST_DIR}/static_detector.cpp ${CMAKE_CURRENT_LIST_DIR}/singer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/correlated_errors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/motion_track.cpp)

# SUNDIALS behind one file, in a library of its own: what it asks of the machine is judged apart
# from the kernels' short list. Static, so that a board needs no further file.
find_path(GLINT_SUNDIALS_INCLUDE arkode/arkode_erkstep.h REQUIRED)
include(${CMAKE_CURRENT_LIST_DIR}/sundials.cmake)
add_library(glint_integrate STATIC ${CMAKE_CURRENT_LIST_DIR}/integrate_motion.cpp)
target_include_directories(glint_integrate SYSTEM PRIVATE ${GLINT_SUNDIALS_INCLUDE})
target_link_libraries(glint_integrate PUBLIC glint_kernels
  PRIVATE glint_core_flags Glint::sundials)
