# Included by this folder's CMakeLists.txt.
find_package(benchmark REQUIRED)
add_executable(bench_dispatch ${CMAKE_CURRENT_LIST_DIR}/dispatch_benchmark.cpp)
target_link_libraries(bench_dispatch PRIVATE glint_graph benchmark::benchmark)
