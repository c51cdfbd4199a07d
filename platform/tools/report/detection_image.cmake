add_library(glint_detection_image STATIC detection_image.cpp)
target_link_libraries(glint_detection_image PUBLIC glint_kernels
  PRIVATE glint_png opencv_imgproc opencv_core)
target_include_directories(glint_detection_image SYSTEM PRIVATE ${OPENCV_INCLUDE})
