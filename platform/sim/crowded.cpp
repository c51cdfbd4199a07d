#include "platform/sim/crowded.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "platform/sim/hand_motion.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/scenarios.hpp"

namespace glint::sim {
namespace {

constexpr int k_markers = 5;
constexpr double k_marker_radius_m = 0.005;
constexpr double k_marker_gap_m = 0.028;  // between centres: most views separate the blobs
const Vector3 k_tool_box_m{0.09, 0.09, 0.05};
constexpr int k_draws_max = 10'000;

// Four columns and four rows inside the field of view of AHAT, from the centre outwards.
constexpr double k_pitch_m = 0.15;
constexpr double k_distance_m = 0.55;

Vector3 in_box(const RandomKey& key, std::uint64_t index, const Vector3& size) {
  return Vector3((uniform(key, 3 * index) - 0.5) * size.x(),
                 (uniform(key, 3 * index + 1) - 0.5) * size.y(),
                 (uniform(key, 3 * index + 2) - 0.5) * size.z());
}

Tool drawn_tool(int number, std::uint64_t seed) {
  const RandomKey key{seed, Stream::blob, static_cast<std::uint64_t>(number)};
  Tool tool;
  tool.marker_radius_m = k_marker_radius_m;
  tool.tip_m = Vector3(0, 0.1, 0);
  std::snprintf(tool.name.data(), tool.name.size(), "crowd%d", number);
  for (std::uint64_t draw = 0; draw < k_draws_max && tool.marker_count < k_markers; ++draw) {
    const Vector3 place = in_box(key, draw, k_tool_box_m);
    bool apart = true;
    for (int i = 0; i < tool.marker_count; ++i) {
      // Lateral distance, since both must be visible from the front.
      const Vector3 away = place - tool.markers_m[static_cast<std::size_t>(i)];
      apart = apart && away.head<2>().norm() >= k_marker_gap_m;
    }
    if (apart) tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = place;
  }
  if (tool.marker_count < k_markers || prepare_tool(tool) != Reason::none) {
    throw std::logic_error("crowded_run: tool " + std::to_string(number) + " cannot be drawn");
  }
  return tool;
}

// Camera frame: x right, y down, z ahead.
Vector3 crowded_position(int tool) {
  static constexpr int order[] = {0, 1, -1, 2};  // in units of the pitch
  return Vector3((order[tool % 4] - 0.5) * k_pitch_m, (order[tool / 4] - 0.5) * k_pitch_m,
                 k_distance_m);
}

Clutter stray(int number, std::uint64_t seed, const Pose& T_world_camera) {
  const RandomKey key{seed, Stream::room, static_cast<std::uint64_t>(1000 + number)};
  const Vector3 place = Vector3(0, 0, 0.85) + in_box(key, 0, Vector3(1.2, 1.2, 0.1));
  return {T_world_camera * place, Vector3::Zero(), 0.005, 12'000};
}

}  // namespace

ToolSet crowd_of_tools(int count, std::uint64_t seed) {
  ToolSet tools;
  tools.count = std::clamp(count, 0, k_tools_max);
  for (int t = 0; t < tools.count; ++t) {
    tools.items[static_cast<std::size_t>(t)] = drawn_tool(t, seed);
  }
  return tools;
}

Scenario crowded_run(const ToolSet& tools, int strays, std::uint64_t seed) {
  Scenario scenario = still_run(hololens2_ahat());
  scenario.seed = seed;
  HeadSettings head;
  head.target_m = Vector3(1, 0, 0);
  scenario.head = head_motion(head, seed);
  const Pose T_world_camera = look_at(head.position_m, head.target_m);
  scenario.tools.clear();
  for (int t = 0; t < tools.count; ++t) {
    ToolBody body;
    body.tool = tools.items[static_cast<std::size_t>(t)];
    body.motion = fixed_motion(T_world_camera * Pose{Quaternion::Identity(), crowded_position(t)});
    scenario.tools.push_back(std::move(body));
  }
  for (int i = 0; i < std::clamp(strays, 0, k_strays_max); ++i) {
    scenario.clutter.push_back(stray(i, seed, T_world_camera));
  }
  return scenario;
}

}  // namespace glint::sim
