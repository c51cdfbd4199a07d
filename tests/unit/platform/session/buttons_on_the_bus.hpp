// What a CAN log says of the pen's buttons, by the places of their bits and no reader of Glint's.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "platform/can/candump_line.hpp"

namespace glint {

// Of the first tool, in the order of the ticks: bits 59 to 61 of each frame 0x1A4, or the three
// highest of byte 3 of each CAN FD frame 0x1A8.
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
