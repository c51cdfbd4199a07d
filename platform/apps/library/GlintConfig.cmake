# find_package(Glint): Eigen and SUNDIALS of the machine, then Glint's own targets.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/sundials.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/GlintTargets.cmake)
