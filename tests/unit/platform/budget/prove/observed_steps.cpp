#include "tests/unit/platform/budget/prove/observed_steps.hpp"

#include <sys/ptrace.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

// First and last byte of the toy functions: the linker makes these symbols of a section's name.
extern "C" const char __start_toy_code[], __stop_toy_code[];

namespace glint::prove {

std::int64_t observed_steps(ToyFunction function, const int* values, int count) {
  const int process = fork();
  if (process < 0) return -1;
  if (process == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
    (void)raise(SIGSTOP);
    volatile int result = function(values, count);
    (void)result;
    _exit(0);
  }
  const auto first = reinterpret_cast<std::uintptr_t>(__start_toy_code);
  const auto end = reinterpret_cast<std::uintptr_t>(__stop_toy_code);
  std::int64_t steps = 0;
  for (int status = 0; waitpid(process, &status, 0) == process && WIFSTOPPED(status);) {
    user_regs_struct registers;
    if (ptrace(PTRACE_GETREGS, process, nullptr, &registers) != 0) return -1;
    if (registers.rip >= first && registers.rip < end) ++steps;
    if (ptrace(PTRACE_SINGLESTEP, process, nullptr, nullptr) != 0) return -1;
  }
  return steps > 0 ? steps : -1;
}

}  // namespace glint::prove
