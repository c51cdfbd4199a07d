// Scenario: all parameters of a simulated run, as plain declared values.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/sim/chessboard.hpp"
#include "platform/sim/device_errors.hpp"
#include "platform/sim/localisation.hpp"
#include "platform/sim/motion.hpp"
#include "platform/sim/noise.hpp"
#include "platform/sim/room.hpp"
#include "platform/sim/timing.hpp"

namespace glint::sim {

// Capsule: the pen's shaft, a finger, a forearm.
struct Capsule {
  Vector3 a = Vector3::Zero(), b = Vector3::Zero();  // metres
  double radius_m = 0;
  double signal = 0;  // counts at 0.5 m
};

// A tool and the parts that move with it, in the tool's frame.
struct ToolBody {
  Tool tool;
  MotionPointer motion;                    // T_world_tool
  Vector3 disc_normal = Vector3::UnitX();  // normal of flat discs; both faces reflect
  std::vector<Capsule> parts;              // shaft, hand: they occlude markers
};

// Bright objects that are no tool: lamps, tape. Fixed in the world.
struct Clutter {
  Vector3 position_m = Vector3::Zero();
  Vector3 normal = Vector3::Zero();  // of a disc; zero: a sphere
  double radius_m = 0.005;
  double signal = 8000;  // counts at 0.5 m
};

// A hand between camera and tool: a sphere that enters from the side, on the line to the tool.
struct OcclusionEvent {
  Interval during;
  int tool = 0;
  double radius_m = 0.09;
  double range_fraction = 0.6;
};

// The tool leaves: displaced by away_m (world) within the interval, with transition_s for each
// transition.
struct AbsenceEvent {
  Interval during;
  int tool = 0;
  Vector3 away_m{0, 0, -1.2};
  double transition_s = 0.25;
};

struct Scenario {
  Camera camera;
  std::vector<ToolBody> tools;  // at most k_tools_max
  MotionPointer head;           // T_world_camera
  std::uint64_t seed = 1;
  Duration duration = milliseconds(60'000);
  TimingSettings timing;
  NoiseSettings noise;
  DeviceErrors device;
  SignalSettings signal;
  LocalisationSettings localisation;
  ReferenceSettings reference;
  Room room;
  BackgroundFrame background;  // replaces the room if not empty
  std::optional<Chessboard> calibration_target;
  std::vector<Clutter> clutter;
  std::vector<OcclusionEvent> occlusions;
  std::vector<AbsenceEvent> absences;
};

}  // namespace glint::sim
