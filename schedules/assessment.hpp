// Schedulability analysis of a whole schedule: groups, CAN bus, end-to-end chains, all deadlines.
//
// What:     runs the analyses of this folder in the order of their dependencies. A group's response
//           is the release jitter of its CAN frames; the bus responses complete the chains. Each
//           group response is computed with and without the operating system's share, so that
//           bounds and estimates stay apart.
// Cost:     two analyses of the groups, one of the bus.
#pragma once

#include <string>
#include <vector>

#include "schedules/can_response.hpp"
#include "schedules/group_response.hpp"
#include "schedules/latency.hpp"
#include "schedules/plan.hpp"
#include "schedules/task_model.hpp"

namespace glint {

inline constexpr int k_own_can_node = 0;  // CanMessage::node of Glint's own frames

struct AnalysisInput {
  TaskModel model;  // groups: frame, tick, then any others
  Plan plan;
  SensorTimes sensor;
  std::vector<CanMessage> frames;  // own frames have the tick's gap; assess() adds their jitter
  CanBitRates rates;
  std::int64_t frame_to_can_deadline_ns = 0;
  std::int64_t age_deadline_ns = 0;
};

struct Assessment {
  std::vector<GroupResponse> groups;  // with the operating system's share
  std::vector<CanResponse> can;       // in the order of AnalysisInput::frames
  std::vector<Chain> chains;
  std::vector<std::string> missed_deadlines;  // one line per missed deadline, with the values
  [[nodiscard]] bool holds() const { return missed_deadlines.empty(); }
};

[[nodiscard]] Assessment assess(const AnalysisInput& input);

}  // namespace glint
