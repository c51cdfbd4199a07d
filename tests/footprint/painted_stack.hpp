// A separate stack for a function, filled with a pattern to measure the maximal depth used.
#pragma once

#include <ucontext.h>

#include <cstddef>
#include <cstdint>

namespace glint::footprint {

class PaintedStack {
 public:
  using Function = void (*)(void* argument) noexcept;

  PaintedStack();
  ~PaintedStack();
  PaintedStack(const PaintedStack&) = delete;
  PaintedStack& operator=(const PaintedStack&) = delete;

  // Runs the function on this stack, in the calling thread.
  void run(Function function, void* argument) noexcept;

  // Largest number of bytes below the call that any run wrote to.
  [[nodiscard]] std::size_t used_bytes() const noexcept;

  static constexpr std::size_t k_bytes = 1024 * 1024;

 private:
  static void enter(unsigned high, unsigned low) noexcept;
  void serve() noexcept;

  unsigned char* memory_;
  std::uintptr_t top_ = 0;  // stack pointer at the call
  Function function_ = nullptr;
  void* argument_ = nullptr;
  ucontext_t caller_{};
  ucontext_t own_{};
};

}  // namespace glint::footprint
