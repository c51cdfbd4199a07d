// What a measured time was measured on.
#pragma once

#include <fstream>
#include <string>

namespace glint {

// As the kernel names it; arm64's names none.
[[nodiscard]] inline std::string processor_name() {
  std::ifstream lines("/proc/cpuinfo");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "a processor without a name";
}

}  // namespace glint
