target_sources(glint_kernels PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/can_decode.cpp
  ${CMAKE_CURRENT_LIST_DIR}/can_frames.cpp
  ${CMAKE_CURRENT_LIST_DIR}/crc.cpp
  ${CMAKE_CURRENT_LIST_DIR}/e2e.cpp
  ${CMAKE_CURRENT_LIST_DIR}/node_frames.cpp
  ${CMAKE_CURRENT_LIST_DIR}/output_record.cpp
  ${CMAKE_CURRENT_LIST_DIR}/smallest_three.cpp)
