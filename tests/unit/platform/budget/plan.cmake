glint_test(plan_file_test plan_file_test.cpp LIBS glint_plan)
glint_test(budget_check_test background_test.cpp check_test.cpp LIBS glint_budget_check)
