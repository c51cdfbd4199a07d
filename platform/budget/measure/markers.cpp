#include "platform/budget/measure/markers.hpp"

// In a file of their own, so that no compiler sees through the calls; different bodies, so that no
// linker folds them into one address.
extern "C" {
[[gnu::noinline, gnu::aligned(64)]] void glint_measure_begin() noexcept { asm volatile("nop"); }
[[gnu::noinline, gnu::aligned(64)]] void glint_measure_end() noexcept {
  asm volatile("nop\n\tnop");
}
}
