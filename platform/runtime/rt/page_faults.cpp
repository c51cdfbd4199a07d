#include "platform/runtime/rt/page_faults.hpp"

#include <sys/resource.h>

#include <atomic>

namespace glint {
namespace {

// More than any group's nodes need (tests/footprint), less than a thread's 8 MB.
constexpr std::size_t k_stack_bytes = 512 * 1024;
constexpr std::size_t k_page_bytes = 4096;

constinit std::atomic<std::uint64_t> faults{0};
constinit thread_local std::uint64_t t_before = 0;

std::uint64_t of_this_thread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
}

}  // namespace

void PageFaultCounter::arm() noexcept { t_before = of_this_thread(); }
void PageFaultCounter::disarm() noexcept {
  faults.fetch_add(of_this_thread() - t_before, std::memory_order_relaxed);
}
std::uint64_t PageFaultCounter::count() noexcept { return faults.load(); }

void prefault_stack() noexcept {
  unsigned char stack[k_stack_bytes];
  for (std::size_t i = 0; i < k_stack_bytes; i += k_page_bytes) stack[i] = 0;
  __asm__ __volatile__("" : : "r"(stack) : "memory");  // keeps the stores
}

}  // namespace glint
