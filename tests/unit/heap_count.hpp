// How often the calling thread asked for memory while this object lived. The test's executable
// links glint_allocation_counter; under sanitizers nothing is counted, so such a test skips.
#pragma once

#include "platform/rt/allocation_counter.hpp"

namespace glint {

class HeapCount {
 public:
  HeapCount() : before_(AllocationCounter::count()) { AllocationCounter::arm(); }
  ~HeapCount() { AllocationCounter::disarm(); }
  HeapCount(const HeapCount&) = delete;
  HeapCount& operator=(const HeapCount&) = delete;
  [[nodiscard]] std::uint64_t count() const { return AllocationCounter::count() - before_; }

 private:
  std::uint64_t before_;
};

}  // namespace glint
