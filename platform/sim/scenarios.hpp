// Predefined scenarios.
#pragma once

#include <string>
#include <vector>

#include "platform/formats/trajectory.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

inline constexpr int k_aligning_frames = 1000;  // static, before each experiment's samples
inline constexpr int k_static_frames = 5000;
inline constexpr int k_dynamic_frames = 2000;  // in each of k_dynamic_runs
inline constexpr int k_dynamic_runs = 5;

// HoloLens 2 AHAT, 60 s, with hands and bright clutter. The camera drops to 5 Hz for 4 s, a hand
// hides the pen for 1 s, the pen is away for 2 s. Default tool: the built-in pen.
[[nodiscard]] Scenario default_run(const std::vector<Tool>& tools = {});

// The same scene without events, clutter or motion.
[[nodiscard]] Scenario still_run(const Camera& camera, const std::vector<Tool>& tools = {});

// Scene, motion and clutter of the default run without its events, with another camera.
[[nodiscard]] Scenario hand_held_run(const Camera& camera, const std::vector<Tool>& tools,
                                     std::uint64_t seed);

// Lays one of the tools on the table beside the workplace, without a hand: a static reference.
void lay_on_table(Scenario& scenario, std::size_t tool);

// Recorded motion: the head's unchanged, the first tool's in the camera's frame, at arm's length,
// scaled. Other tools are static in the world.
[[nodiscard]] Scenario trajectory_run(const Camera& camera, const std::vector<Tool>& tools,
                                      const Trajectory& head, const Trajectory& pen,
                                      double pen_scale);

// HoloLens 1. Static: headset and pen static, at arm's length, k_aligning_frames + k_static_frames.
// Dynamic: k_aligning_frames static, then k_dynamic_frames with both in motion; the runs
// 0..k_dynamic_runs-1 differ in their random seed. Both have the same declared error sources.
[[nodiscard]] Scenario experiment_static(const std::vector<Tool>& tools = {});
[[nodiscard]] Scenario experiment_dynamic(int run, const std::vector<Tool>& tools = {});
[[nodiscard]] NoiseSettings hololens1_noise();
[[nodiscard]] SignalSettings hololens1_signal();
[[nodiscard]] LocalisationSettings hololens1_localisation();

}  // namespace glint::sim
