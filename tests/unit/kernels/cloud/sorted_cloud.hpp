// A point cloud together with the grid that sorts it.
#pragma once

#include "clouds.hpp"
#include "kernels/cloud/neighbour_grid.hpp"

namespace glint {

struct SortedCloud {
  explicit SortedCloud(const std::vector<Point>& of, float cell_m, int slice = 1 << 20)
      : cloud(of), memory(NeighbourGrid::bytes(static_cast<int>(of.size()))) {
    EXPECT_EQ(grid.prepare(static_cast<int>(of.size()), memory.arena()), Reason::none);
    grid.begin(cloud.points, cell_m);
    while (!grid.sorted()) grid.sort(slice);
  }
  TestCloud cloud;
  TestMemory memory;
  NeighbourGrid grid;
};

}  // namespace glint
