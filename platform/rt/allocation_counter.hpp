// Counts the heap allocations of threads that have declared themselves free of them.
//
// Works in executables that link the object library glint_allocation_counter, which puts its own
// malloc family (and so operator new) in front of the C library's; not under sanitizers, which do
// the same. An unarmed thread pays one test of a thread-local flag.
#pragma once

#include <cstdint>

namespace glint {

class AllocationCounter {
 public:
  // Whether allocations are seen in this executable; if not, count() stays 0 and means nothing.
  [[nodiscard]] static bool available() noexcept;

  // From now on, until disarm(), the calling thread's allocations count.
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
