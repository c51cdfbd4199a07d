// Runs a program that may crash, hang or write without end, and takes its output.
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
  killed,     // by a signal: it crashed
  timed_out,  // and was killed for it
  too_much,   // wrote more than the limit, and was killed for it
};

struct ProcessOutput {
  ProcessEnd end = ProcessEnd::failed;
  std::string bytes;  // of its standard output
};

struct ProcessLimits {
  std::size_t output_bytes = 0;
  Duration time;
};

// command[0] is the program's path. Its input and its error output are /dev/null. Safe in a process
// with other threads: posix_spawn runs no code of ours between fork and exec. Throws MissingDevice
// where the program cannot be started.
[[nodiscard]] ProcessOutput output_of(std::vector<std::string> command,
                                      const ProcessLimits& limits);

}  // namespace glint
