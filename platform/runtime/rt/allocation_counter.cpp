#include "platform/runtime/rt/allocation_counter.hpp"

#include <atomic>

namespace glint {
namespace {

// Constant-initialised: the C library allocates before any constructor runs.
constinit thread_local bool t_armed = false;
constinit std::atomic<std::uint64_t> allocations{0};
constinit std::atomic<bool> interposed{false};

}  // namespace

bool AllocationCounter::available() noexcept { return interposed.load(); }
void AllocationCounter::arm() noexcept { t_armed = true; }
void AllocationCounter::disarm() noexcept { t_armed = false; }
std::uint64_t AllocationCounter::count() noexcept { return allocations.load(); }

void detail::note_allocation() noexcept {
  if (t_armed) allocations.fetch_add(1, std::memory_order_relaxed);
}
void detail::note_interposition() noexcept { interposed.store(true); }

}  // namespace glint
