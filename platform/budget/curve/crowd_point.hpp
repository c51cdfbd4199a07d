// One point of the cost curve: a number of tools and of stray reflections in a full AHAT frame.
#pragma once

#include <string>
#include <vector>

#include "platform/cells/cell.hpp"

namespace glint {

struct DenseScenePoint {
  int tools = 1;
  int strays = 0;
  [[nodiscard]] std::string name() const {
    return std::to_string(tools) + "_tools_" + std::to_string(strays) + "_strays";
  }
};

// Points along both axes through the usual cell (5 tools, 20 strays), and the two far corners.
[[nodiscard]] std::vector<DenseScenePoint> crowd_points();

// The default cell with these tools. With up to five tools it has the default's 64 blobs; with more
// it has the maximum, since 16 tools alone have 80 markers.
[[nodiscard]] Cell crowd_cell(int tools);

}  // namespace glint
