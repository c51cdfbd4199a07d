// What the DDS sink and its reader must agree on.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "platform/record/button_event.hpp"
#include "platform/report/calibration_findings.hpp"
#include "platform/rt/followed_robot.hpp"
#include "platform/rt/loss_counters.hpp"
#include "platform/rt/overrun_counters.hpp"

namespace glint {

// Frame names as tf carries them (REP-103: the camera's is an optical frame).
struct FrameNames {
  std::string camera = "hmd_tof_optical";
  std::string world = "hmd_world";
  std::string robot = "robot_base";
};

struct StaticTransform {
  std::string parent;
  std::string child;
  Pose T_parent_child;
};

struct DdsSettings {
  int domain = 0;                  // ROS_DOMAIN_ID, 0..232
  std::string interface = "lo";    // multicast is used unless it is a loopback interface
  std::vector<std::string> peers;  // further addresses to look for participants at
  std::string topic_prefix = "glint";
  std::vector<std::string> tool_names = {"pen"};  // element i names PoseSample::tool i
  FrameNames frames;
  std::vector<StaticTransform> static_transforms;  // all of tf_static
  Duration tick_period = milliseconds(4);
  Duration actuation_delay;  // a pose is valid this long after its tick
  // Another participant's message may add and remove the tools named above.
  bool hears_tool_changes = false;
  Duration button_timeout = k_button_timeout;  // of a held button that nobody repeats
  Duration unix_minus_board;                   // added to a PoseSample's times to stamp messages
  Duration poll_period = microseconds(500);    // of the ring, by the sink's thread
  // What /diagnostics says beside the tools: what this machine spoils (empty: nothing), and the
  // overruns so far (null: not counted; it outlives the sink).
  std::string best_effort;
  const OverrunCounters* overruns = nullptr;
  // And what the run has lost so far (null: not counted; it outlives the sink).
  const LossCounters* losses = nullptr;
  // And the robot that is followed (null: none is; it outlives the sink).
  const FollowedRobotNotes* robot = nullptr;
  // And what the tools' residuals show of calibration errors (null: not watched; likewise).
  const CalibrationNotes* calibration = nullptr;
};

}  // namespace glint
