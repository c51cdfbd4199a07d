// Settings that the DDS sink and its reader share.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "platform/cells/dds_input.hpp"
#include "platform/runtime/rt/followed_robot.hpp"
#include "platform/runtime/rt/loss_counters.hpp"
#include "platform/runtime/rt/overrun_counters.hpp"
#include "platform/runtime/rt/source_faults.hpp"
#include "platform/sinks/dds/input_access.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/tools/report/calibration_findings.hpp"

namespace glint {

// Frame names in tf (REP-103: the camera's is an optical frame).
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
  std::string interface = "lo";    // multicast unless it is a loopback interface
  std::vector<std::string> peers;  // further addresses for discovery
  std::string security;            // folder with keys and documents; empty: no DDS Security
  std::string topic_prefix = "glint";
  std::string name;  // namespace of all topics and of the node; empty: none
  RosGraph ros_graph = RosGraph::off;
  std::vector<std::string> tool_names = {"pen"};  // element i names PoseSample::tool i
  FrameNames frames;
  std::string robot_description;                   // URDF; empty: not published
  std::vector<StaticTransform> static_transforms;  // all of tf_static
  Duration tick_period = milliseconds(4);
  Duration actuation_delay;  // from a tick to the time for which its pose is valid
  // Access to the inputs (null: all are allowed at any rate; must outlive the inputs and the sink).
  InputAccess* access = nullptr;
  Duration button_timeout = k_button_timeout;  // of a held button without repeated messages
  Duration unix_minus_session;                 // offset from a PoseSample's times to Unix time
  Duration poll_period = microseconds(500);    // of the sink's thread, for its ring
  // Further contents of /diagnostics: this machine's timing faults (empty: none) and the overruns
  // so far (null: not counted; must outlive the sink).
  std::string timing_faults;
  const OverrunCounters* overruns = nullptr;
  // Output losses so far (null: not counted; must outlive the sink).
  const LossCounters* losses = nullptr;
  // Faults of a live source (null: none; must outlive the sink). A new one is published at once.
  const SourceFaults* source = nullptr;
  // State of the followed robot (null: none; must outlive the sink).
  const RobotTrackingStatus* robot = nullptr;
  // Estimated calibration errors (null: not monitored; must outlive the sink).
  const CalibrationFindingsStore* calibration = nullptr;
};

// Domain, interface, security, name and graph of a cell's [dds].
struct DdsCellSettings;
[[nodiscard]] DdsSettings network_of(const DdsCellSettings& cell);

}  // namespace glint
