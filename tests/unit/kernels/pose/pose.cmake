glint_test(glint_pose_test ../elementary_test.cpp best_rotation_test.cpp rigid_fit_test.cpp
  fit_covariance_test.cpp bias_correction_test.cpp correspond_test.cpp
  correspond_prediction_test.cpp correspond_crowd_test.cpp partner_counts_test.cpp assign_test.cpp
  refine_pose_test.cpp weighted_fit_test.cpp marker_sight_test.cpp decide_labeling_test.cpp
  partial_visibility_test.cpp expected_pose_test.cpp map_pose_test.cpp blob_size_test.cpp
  RELEASE calibration_errors_test.cpp choose_hypothesis_test.cpp noise_estimate_test.cpp
    systematic_covariance_test.cpp candidates_test.cpp pair_matches_test.cpp
    correspond_search_test.cpp refine_work_test.cpp fit_steps_test.cpp fit_parts_test.cpp
    noise_residuals_test.cpp calibration_sums_test.cpp
  LIBS glint_kernels glint_dense LABELS unit SHARDS 2 COMPUTES)
