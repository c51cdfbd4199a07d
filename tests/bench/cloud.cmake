# Included by this folder's CMakeLists.txt. The rival is PCL, where it is installed.
add_executable(bench_cloud alignment_glint.cpp alignment_race.cpp cloud_agreement.cpp
  cloud_benchmark.cpp cloud_glint.cpp)
target_link_libraries(bench_cloud PRIVATE glint_registration glint_sensors ${CMAKE_DL_LIBS})
target_compile_definitions(bench_cloud PRIVATE ${bench_flags}
  GLINT_BENCH_PCL="libbench_cloud_pcl.so")

find_path(GLINT_PCL_INCLUDE pcl/pcl_base.h PATH_SUFFIXES pcl-1.13)
set(pcl_found ${GLINT_PCL_INCLUDE})
foreach(module common filters kdtree octree registration sample_consensus search segmentation surface)
  find_library(GLINT_PCL_${module} pcl_${module})
  list(APPEND pcl_libraries ${GLINT_PCL_${module}})
  if(NOT GLINT_PCL_${module})
    set(pcl_found FALSE)
  endif()
endforeach()
if(pcl_found)
  # Loaded while it runs, and its symbols kept to itself: PCL is built with another layout of Eigen's
  # types than Glint.
  add_library(bench_cloud_pcl MODULE alignment_pcl.cpp cloud_pcl.cpp)
  target_include_directories(bench_cloud_pcl SYSTEM PRIVATE ${GLINT_PCL_INCLUDE})
  target_compile_options(bench_cloud_pcl PRIVATE -UEIGEN_DONT_VECTORIZE -fvisibility=hidden -w)
  target_link_libraries(bench_cloud_pcl PRIVATE Eigen3::Eigen ${pcl_libraries})
  set_target_properties(bench_cloud_pcl PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  add_dependencies(bench_cloud bench_cloud_pcl)
else()
  message(STATUS "libpcl-dev is not installed: bench_cloud shows Glint alone")
endif()
