glint_test(test_probe_points probe_points_test.cpp LIBS glint_session LABELS accuracy)
