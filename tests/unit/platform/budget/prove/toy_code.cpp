// Functions whose longest paths are known, in the machine code of the test's own program. Their
// loops' maxima are in toy_loops.toml, by the lines of this file.
#include "tests/unit/platform/budget/prove/toy_code.hpp"

#include <cstring>

#define TOY extern "C" [[gnu::noinline, gnu::noipa, gnu::section("toy_code")]]

TOY int toy_sum(const int* values, int count) {
  int sum = 0;
  for (int i = 0; i < count; ++i) {
    if (values[i] < 0) break;
    sum = sum * 3 + values[i];
  }
  return sum;
}

TOY int toy_calls(const int* values, int count) {
  return toy_sum(values, count) - toy_sum(values + 1, count);
}

// At most `count` passes of the inner loop in all, however many the outer loop makes.
TOY int toy_stretches(const int* values, int count) {
  int at = 0, sum = 0;
  while (at < count) {
    sum = sum * 5 + 1;
    while (at < count && values[at] != 0) {
      sum = sum * 7 + values[at];
      ++at;
    }
    ++at;
  }
  return sum;
}

// Only the value 123456789 takes the expensive branch.
TOY int toy_rare(const int* values, int count) {
  if (values[0] == 123456789) {
    return toy_sum(values, count) + toy_sum(values + 1, count - 1) * toy_sum(values, count);
  }
  return values[0];
}

TOY int toy_unknown_loop(const int* values, int /*count*/) {
  int at = 0;
  while (values[at] > 0) ++at;
  return at;
}

TOY int toy_recursion(const int* values, int count) {
  return count <= 0 ? values[0]
                    : toy_recursion(values, count - 1) * toy_recursion(values, count - 2);
}

static int (*volatile toy_function)(const int*, int) = toy_sum;
TOY int toy_indirect_call(const int* values, int count) { return toy_function(values, count) + 1; }

TOY int toy_switch(const int* values, int count) {
  switch (count) {
    case 0:
      return values[0] * 3;
    case 1:
      return values[1] - 7;
    case 2:
      return values[2] ^ 9;
    case 3:
      return values[3] / 3;
    case 4:
      return values[4] % 5;
    case 5:
      return toy_sum(values, 2);
    case 6:
      return values[6] << 3;
    default:
      return 0;
  }
}

TOY int toy_copy(const int* values, int count) {
  int copy[64];
  std::memcpy(copy, values, static_cast<std::size_t>(count) * sizeof(int));
  return toy_sum(copy, count);
}

// Both loops count to constants, so they need no entry.
TOY int toy_counted(const int* values, int /*count*/) {
  int sum = 0;
  for (int i = 0; i < 12; ++i) sum = sum * 3 + values[i] % 5;
  for (int i = 40; i > 2; i -= 3) sum = sum * 7 + values[i] % 11;
  return sum;
}

// A cycle that is entered at its first instruction or at its second one.
TOY int toy_two_entries(const int* values, int count) {
  int sum = values[0];
  asm volatile("test %0, %0; jz 2f; 1: add $3, %0; 2: add $5, %0; dec %1; jg 1b"
               : "+r"(sum), "+r"(count)
               :
               : "cc");
  return sum;
}

// The step of the counter depends on the values.
TOY int toy_uneven(const int* values, int /*count*/) {
  int sum = 0;
  for (int i = 0; i < 40;) {
    sum = sum * 3 + values[i];
    i += sum > 5 ? 1 : 3;
  }
  return sum;
}

// The inner loop makes one pass more in each pass of the outer one.
TOY int toy_triangle(const int* values, int count) {
  int sum = 0;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < i; ++j) sum = sum * 3 + values[j] % 5;
  }
  return sum;
}

TOY int toy_seldom(const int* values, int count) {
  int sum = 0;
  for (int i = 0; i < count; ++i) {
    if (values[i] == 7) sum += toy_sum(values, count);
  }
  return sum;
}
