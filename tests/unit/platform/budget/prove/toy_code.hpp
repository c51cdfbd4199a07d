// Functions whose longest paths are known.
#pragma once

extern "C" {
int toy_sum(const int* values, int count);
int toy_calls(const int* values, int count);
int toy_stretches(const int* values, int count);
int toy_rare(const int* values, int count);
int toy_unknown_loop(const int* values, int count);
int toy_recursion(const int* values, int count);
int toy_indirect_call(const int* values, int count);
int toy_switch(const int* values, int count);
int toy_copy(const int* values, int count);
int toy_counted(const int* values, int count);
int toy_two_entries(const int* values, int count);
int toy_triangle(const int* values, int count);
}
