// Counts heap allocations of armed threads, which must not allocate.
//
// Works in executables that link the object library glint_allocation_counter. It replaces the C
// library's malloc family (and so operator new); not under sanitizers, which do the same. An
// unarmed thread pays one test of a thread-local flag.
#pragma once

#include <cstdint>

namespace glint {

class AllocationCounter {
 public:
  // True if this executable counts allocations; otherwise count() stays 0 and is meaningless.
  [[nodiscard]] static bool available() noexcept;

  // The calling thread's allocations count from arm() to disarm().
  static void arm() noexcept;
  static void disarm() noexcept;

  // Allocations by armed threads since the start of the process.
  [[nodiscard]] static std::uint64_t count() noexcept;
};

namespace detail {
void note_allocation() noexcept;
void note_interposition() noexcept;
}  // namespace detail

}  // namespace glint
