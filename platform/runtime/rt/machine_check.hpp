// Checks the machine's real-time configuration: kernel, rights, cores, idle states, interrupts.
// Reads it once at the start; changes nothing and rejects nothing.
#pragma once

#include <string>
#include <vector>

namespace glint {

struct MachineCheck {
  bool preempt_rt = false;
  // One line per defect: what was found, its effect on latency, the remedy. Empty: none found.
  std::vector<std::string> timing_faults;
};

// For threads pinned to `cores` (empty: not pinned). `root` contains /proc and /sys.
[[nodiscard]] MachineCheck check_machine(const std::vector<int>& cores,
                                         const std::string& root = "/");

}  // namespace glint
