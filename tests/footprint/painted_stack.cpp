#include "tests/footprint/painted_stack.hpp"

#include <sys/mman.h>

#include <cstring>
#include <stdexcept>

namespace glint::footprint {
namespace {

constexpr unsigned char k_paint = 0xA5;

[[nodiscard]] inline std::uintptr_t stack_pointer() noexcept {
  std::uintptr_t value;
#if defined(__x86_64__)
  asm volatile("mov %%rsp, %0" : "=r"(value));
#elif defined(__aarch64__)
  asm volatile("mov %0, sp" : "=r"(value));
#endif
  return value;
}

}  // namespace

PaintedStack::PaintedStack() {
  void* const memory = mmap(nullptr, k_bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory for a painted stack");
  memory_ = static_cast<unsigned char*>(memory);
  std::memset(memory_, k_paint, k_bytes);
  getcontext(&own_);
  own_.uc_stack.ss_sp = memory_;
  own_.uc_stack.ss_size = k_bytes;
  own_.uc_link = nullptr;
  // makecontext passes ints only, so the pointer is split into two halves.
  const auto self = reinterpret_cast<std::uintptr_t>(this);
  makecontext(&own_, reinterpret_cast<void (*)()>(&PaintedStack::enter), 2,
              static_cast<unsigned>(self >> 32), static_cast<unsigned>(self));
}

PaintedStack::~PaintedStack() { munmap(memory_, k_bytes); }

void PaintedStack::enter(unsigned high, unsigned low) noexcept {
  const std::uintptr_t self = static_cast<std::uintptr_t>(high) << 32 | low;
  reinterpret_cast<PaintedStack*>(self)->serve();
}

void PaintedStack::serve() noexcept {
  for (;;) {
    top_ = stack_pointer();
    function_(argument_);
    swapcontext(&own_, &caller_);
  }
}

void PaintedStack::run(Function function, void* argument) noexcept {
  function_ = function;
  argument_ = argument;
  swapcontext(&caller_, &own_);
}

std::size_t PaintedStack::used_bytes() const noexcept {
  std::size_t clean = 0;
  while (clean < k_bytes && memory_[clean] == k_paint) ++clean;
  const std::uintptr_t deepest = reinterpret_cast<std::uintptr_t>(memory_) + clean;
  return deepest < top_ ? top_ - deepest : 0;
}

}  // namespace glint::footprint
