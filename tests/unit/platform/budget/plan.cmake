glint_test(plan_file_test plan_file_test.cpp LIBS glint_plan)
