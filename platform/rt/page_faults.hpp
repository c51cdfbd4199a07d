// Counts the page faults of threads that have declared themselves free of them.
#pragma once

#include <cstdint>

namespace glint {

class PageFaultCounter {
 public:
  // From here to disarm(), in the same thread, the thread's page faults count.
  static void arm() noexcept;
  static void disarm() noexcept;

  // Minor and major, of threads that have disarmed, since the start of the process.
  [[nodiscard]] static std::uint64_t count() noexcept;
};

// Touches the stack below the caller, so that it is in memory before it is needed.
void prefault_stack() noexcept;

}  // namespace glint
