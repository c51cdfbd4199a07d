glint_test(test_points_csv points_csv_test.cpp LIBS glint_points LABELS unit)
