# Plans as files, and the task model of a cell.
add_library(glint_plan STATIC plan_file.cpp plan_text.cpp task_model_of.cpp)
target_link_libraries(glint_plan PUBLIC glint_schedules glint_cells glint_nodes glint_toml)

# What `glint budget schedule` and `check` compute.
add_library(glint_budget_check STATIC bus_frames.cpp check.cpp check_observed.cpp proved_bounds.cpp
  check_report.cpp slack_table.cpp typical_load.cpp)
target_link_libraries(glint_budget_check PUBLIC glint_plan glint_board_file
  glint_trace_export nlohmann_json::nlohmann_json)
