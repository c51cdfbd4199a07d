// What this machine spoils of a latency bound, each with what to do about it. Looked at once, at
// the start; nothing is changed and nothing is refused.
#pragma once

#include <string>
#include <vector>

namespace glint {

struct MachineCheck {
  bool preempt_rt = false;
  // One line each: what was found, what spoils, what to do. Empty: nothing that we know of.
  std::vector<std::string> spoils;
};

// For threads pinned to `cores` (empty: to none). `root` is where /proc and /sys are.
[[nodiscard]] MachineCheck check_machine(const std::vector<int>& cores,
                                         const std::string& root = "/");

}  // namespace glint
