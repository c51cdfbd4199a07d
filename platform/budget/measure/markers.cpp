#include "platform/budget/measure/markers.hpp"

// A separate file, so that no compiler inlines the calls; different bodies, so that no linker folds
// them into one address.
extern "C" {
[[gnu::noinline, gnu::aligned(64)]] void glint_measure_begin() noexcept { asm volatile("nop"); }
[[gnu::noinline, gnu::aligned(64)]] void glint_measure_end() noexcept {
  asm volatile("nop\n\tnop");
}
}
