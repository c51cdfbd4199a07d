// Objects in front of the camera at one frame's mid-exposure, in the camera's frame.
#pragma once

#include <array>
#include <cstdint>

#include "platform/sim/reflector.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

inline constexpr int k_clutter_max = 256;
inline constexpr int k_reflectors_max = k_tools_max * k_markers_per_tool_max + k_clutter_max;
inline constexpr int k_capsules_max = 128;

template <class T, int N>
struct Bounded {
  std::array<T, static_cast<std::size_t>(N)> items;
  int count = 0;

  void push(const T& item) {
    if (count < N) items[static_cast<std::size_t>(count++)] = item;
  }
  [[nodiscard]] T& operator[](int i) { return items[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const T& operator[](int i) const { return items[static_cast<std::size_t>(i)]; }
};

struct Scene {
  Pose T_world_camera;
  Bounded<Reflector, k_reflectors_max> reflectors;  // farthest first
  Bounded<Capsule, k_capsules_max> capsules;
};

// Returns T_world_tool, including the scenario's AwayEvents.
[[nodiscard]] Pose tool_pose(const Scenario& scenario, int tool, Time time);

// Returns the centroid of the markers, tool frame.
[[nodiscard]] Vector3 centroid_of(const Tool& tool);

// sequence: selects the random errors of the blobs.
void build_scene(const Scenario& scenario, Time mid_exposure, std::uint64_t sequence, Scene& out);

}  // namespace glint::sim
