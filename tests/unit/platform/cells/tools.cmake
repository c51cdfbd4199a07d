glint_test(test_tool_file tool_file_test.cpp tool_writer_test.cpp LIBS glint_tool_files LABELS unit)
glint_test(test_cell_budget background_test.cpp budget_test.cpp calibration_files_test.cpp can_test.cpp
  depth_bias_test.cpp reference_test.cpp toml_reader_test.cpp tool_changes_test.cpp
  LIBS glint_cells LABELS unit)
