// Name of the processor, for reports of measured times.
#pragma once

#include <fstream>
#include <string>

namespace glint {

// From /proc/cpuinfo; arm64 states no name there.
[[nodiscard]] inline std::string processor_name() {
  std::ifstream lines("/proc/cpuinfo");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unnamed processor";
}

}  // namespace glint
