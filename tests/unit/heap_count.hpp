// Counts the heap allocations of the calling thread during this object's lifetime. Requires that
// the test's executable links glint_allocation_counter; otherwise its cases fail. A sanitizer owns
// malloc: the count then stays 0, and a test checks memory only.
#pragma once

#include <gtest/gtest.h>

#include "platform/runtime/rt/allocation_counter.hpp"

namespace glint {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // g++
inline constexpr bool k_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool k_sanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool k_sanitized = false;
#endif

class HeapCount {
 public:
  HeapCount() : before_(AllocationCounter::count()) {
    EXPECT_TRUE(AllocationCounter::available() || k_sanitized) << "nothing counts allocations";
    AllocationCounter::arm();
  }
  ~HeapCount() { AllocationCounter::disarm(); }
  HeapCount(const HeapCount&) = delete;
  HeapCount& operator=(const HeapCount&) = delete;
  [[nodiscard]] std::uint64_t count() const { return AllocationCounter::count() - before_; }

 private:
  std::uint64_t before_;
};

}  // namespace glint
