// Measuring program, its architecture and emulator; shared by the commands that measure.
#pragma once

#include <string>

#include "platform/budget/board_file.hpp"
#include "platform/budget/measure/observations.hpp"

namespace glint {

#if defined(__aarch64__)
inline constexpr const char* k_own_arch = "arm64";
#else
inline constexpr const char* k_own_arch = "x86-64";
#endif

struct MeasureTarget {
  std::string program = "glint_measure";  // in the folder of this program or of the other build
  std::string program_file;               // overrides the program's path
  std::string count = "instructions";     // or time
  std::string arch = k_own_arch;
  int jobs = 0;  // kernels measured in parallel; 0: one per core
};

// Returns the next step for times above a board's bounds; "" for instructions, or if `made_by`, the
// command that measured the costs, already evicted the caches.
[[nodiscard]] std::string advice_above_bound(CostCounter counter, const std::string& made_by);

// Throws InputError if an emulator would have to measure time.
[[nodiscard]] MeasureRequest measure_request(const MeasureTarget& target);

}  // namespace glint
