# OpenCV is only what the camera models are compared with.
glint_test(glint_camera_test camera_model_test.cpp local_rays_test.cpp ray_table_test.cpp
  back_project_test.cpp undistort_blobs_test.cpp depth_samples_test.cpp robust_mean_test.cpp
  sphere_shift_test.cpp depth_bias_test.cpp
  RELEASE back_project_frame_test.cpp
  LIBS glint_kernels glint_sensors opencv_calib3d opencv_imgproc opencv_core LABELS unit)
if(TARGET glint_camera_test)
  target_include_directories(glint_camera_test SYSTEM PRIVATE ${OPENCV_INCLUDE})
endif()
