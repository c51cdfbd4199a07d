// All of a plan at once: groups, bus, chains, and whether everything is in time.
//
// What:     the analyses of this folder in the order in which they need each other: responses of
//           the groups, which are the jitter of what they send, which gives the bus, which ends the
//           chains. Each response is computed with and without the operating system's share, so
//           that bounds and estimates stay apart.
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

inline constexpr int k_own_can_node = 0;  // CanMessage::node of what Glint sends itself

struct Question {
  TaskModel model;  // groups: frame, tick, and what else there may be
  Plan plan;
  SensorTimes sensor;
  std::vector<CanMessage> frames;  // own ones with their tick's gap; jitter is filled in
  CanBitRates rates;
  std::int64_t frame_to_can_deadline_ns = 0;
  std::int64_t age_deadline_ns = 0;
};

struct Assessment {
  std::vector<GroupResponse> groups;  // with the system's share
  std::vector<CanResponse> can;       // in the order of Question::frames
  std::vector<Chain> chains;
  std::vector<std::string> fails;  // one line each, with the figures
  [[nodiscard]] bool holds() const { return fails.empty(); }
};

[[nodiscard]] Assessment assess(const Question& question);

}  // namespace glint
