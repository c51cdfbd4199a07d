# Included by this folder's CMakeLists.txt. Needs oneTBB, whose flow graph is the rival.
find_package(TBB QUIET)
if(TBB_FOUND)
  add_executable(bench_dispatch dispatch_benchmark.cpp dispatch_rows.cpp dispatch_tbb.cpp)
  target_link_libraries(bench_dispatch PRIVATE glint_graph TBB::tbb)
  target_compile_definitions(bench_dispatch PRIVATE ${bench_flags})
else()
  message(STATUS "oneTBB is not installed: bench_dispatch is not built (tests/run installs it)")
endif()
