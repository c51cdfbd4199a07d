add_library(glint_picture STATIC picture.cpp)
target_link_libraries(glint_picture PUBLIC glint_kernels
  PRIVATE glint_png opencv_imgproc opencv_core)
target_include_directories(glint_picture SYSTEM PRIVATE ${OPENCV_INCLUDE})
