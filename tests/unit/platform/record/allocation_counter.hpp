// Counts what the calling thread takes from the heap; link allocation_counter.cpp.
#pragma once

namespace glint {

struct AllocationCounter {
  AllocationCounter();
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;
  [[nodiscard]] int count() const;
};

}  // namespace glint
