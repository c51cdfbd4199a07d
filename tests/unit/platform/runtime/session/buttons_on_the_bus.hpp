// Decodes the pen's buttons from a CAN log by bit positions, without Glint's own decoder.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "platform/sinks/can/candump_line.hpp"

namespace glint {

// The first tool's buttons in order of the ticks: bits 59 to 61 of each frame 0x1A4, or the three
// highest bits of byte 3 of each CAN FD frame 0x1A8.
inline std::vector<int> buttons_on_the_bus(const std::string& log, bool fd) {
  std::vector<int> said;
  std::ifstream stream(log);
  for (std::string line; std::getline(stream, line);) {
    const auto record = parse_candump(line);
    EXPECT_TRUE(record) << line;
    if (!record || record->frame.identifier != (fd ? 0x1A8U : 0x1A4U)) continue;
    const auto& data = record->frame.data;
    said.push_back(fd ? data[3] >> 5 : (data[7] >> 3) & 7);
  }
  return said;
}

}  // namespace glint
