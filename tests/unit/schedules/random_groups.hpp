// Random groups of nodes, and fork-join groups like the tracker's: copies between single nodes.
#pragma once

#include <random>
#include <string>

#include "schedules/task_model.hpp"

namespace glint {

inline TaskGroup random_group(std::mt19937_64& random, int nodes, int edge_percent,
                              unsigned bound_max = 20) {
  TaskGroup group;
  group.name = "random";
  for (int n = 0; n < nodes; ++n) {
    TaskNode node;
    node.name = std::string("N").append(std::to_string(n));
    node.bound_ns = 1 + static_cast<std::int64_t>(random() % bound_max);
    for (int before = 0; before < n; ++before) {
      if (static_cast<int>(random() % 100) < edge_percent) node.after.push_back(before);
    }
    group.nodes.push_back(node);
  }
  return group;
}

struct Stage {
  std::string name;
  int copies = 1;
  std::int64_t bound_ns = 0;
};

// Each copy of a stage reads all copies of the previous stage.
inline TaskGroup staged_group(const std::vector<Stage>& stages) {
  TaskGroup group;
  group.name = "frame";
  std::vector<int> before;
  for (const Stage& stage : stages) {
    std::vector<int> own;
    for (int copy = 0; copy < stage.copies; ++copy) {
      own.push_back(static_cast<int>(group.nodes.size()));
      group.nodes.push_back({stage.name, copy, stage.copies, stage.bound_ns, before});
    }
    before = own;
  }
  return group;
}

inline TaskGroup tracker_like_group() {
  return staged_group({{"StampFrame", 1, 300},
                       {"CheckFrame", 1, 500},
                       {"PredictTracks", 1, 9'000},
                       {"LocateRois", 1, 6'000},
                       {"RoiThreshold", 4, 41'000},
                       {"FindBlobs", 1, 38'000},
                       {"BackProject", 1, 27'000},
                       {"Correspond", 4, 55'000},
                       {"AssignMarkers", 1, 12'000},
                       {"RefinePose", 4, 18'000},
                       {"TrackTools", 1, 16'000}});
}

}  // namespace glint
