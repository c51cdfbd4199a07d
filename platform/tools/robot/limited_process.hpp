// Subprocess with limits on time and output: for programs that may crash, hang or write endlessly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

enum class ProcessEnd : std::uint8_t {
  done,       // exit code 0
  failed,     // another exit code
  killed,     // by a signal: crash
  timed_out,  // killed at the time limit
  too_much,   // killed at the output limit
};

struct ProcessOutput {
  ProcessEnd end = ProcessEnd::failed;
  std::string bytes;  // standard output
};

struct ProcessLimits {
  std::size_t output_bytes = 0;
  Duration time;
};

// command[0] is the program's path. Its standard input and error are /dev/null. Safe in a process
// with other threads: posix_spawn runs no own code between fork and exec. Throws MissingDevice if
// the program cannot be started.
[[nodiscard]] ProcessOutput output_of(std::vector<std::string> command,
                                      const ProcessLimits& limits);

}  // namespace glint
