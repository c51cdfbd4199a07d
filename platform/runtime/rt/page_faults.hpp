// Counts page faults of armed threads, which must not have any.
#pragma once

#include <cstdint>

namespace glint {

class PageFaultCounter {
 public:
  // The calling thread's page faults count from arm() to disarm().
  static void arm() noexcept;
  static void disarm() noexcept;

  // Minor and major faults of threads that have called disarm(), since the start of the process.
  [[nodiscard]] static std::uint64_t count() noexcept;
};

// Touches the stack below the caller, so that its pages are resident.
void prefault_stack() noexcept;

}  // namespace glint
