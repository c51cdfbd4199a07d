// The values that travel between nodes, beyond those a kernel already names (Frame, Rois, Runs,
// Blobs, Markers, ToolSet, HeadPose).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/limits.hpp"
#include "kernels/motion/head_anchor.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_track.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "kernels/pose/few_markers.hpp"
#include "kernels/pose/labeling.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/noise_estimate.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/reason.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

// How many copies the tools are spread over; never the worker count.
inline constexpr int k_tool_slices = 4;
inline constexpr int k_tools_per_slice = (k_tools_max + k_tool_slices - 1) / k_tool_slices;

// What is known of a frame without its pixels.
struct FrameStamp {
  Time mid_exposure;
  Duration sigma;  // of mid_exposure, as the frame states it
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_invalid: wrong size, or a plane is missing
};

// Whether this activation's frame may be used, and what had to be refused so far.
struct FrameVerdict {
  FrameStamp stamp;
  Reason reason = Reason::none;  // frame_late, frame_doubled, frame_invalid
  bool resynchronised = false;   // the stamps restarted: older tracks mean nothing any more
  std::uint64_t accepted = 0;    // counters since the start
  std::uint64_t late = 0, doubled = 0, invalid = 0, resynchronisations = 0;
  [[nodiscard]] bool usable() const { return reason == Reason::none; }
};

// Where each tool should be seen at this frame's mid-exposure.
struct Prediction {
  bool has_prior = false;
  bool missed_last = false;  // the last frame did not show it: search the whole frame
  Pose T_camera_tool;
  double reach_m = 0;  // how far the tool's markers may be from there
  // By its followed motion, so that the covariance holds: of the middle of its markers, about the
  // camera's axes. Else the tool is held where the camera saw it.
  bool follows_motion = false;
  bool only_near = false;     // its speed is known, too: what lies beyond reach_m is not it
  double odds = k_odds_most;  // of that motion against another (expected_pose.hpp)
  Matrix6 covariance = Matrix6::Zero();
  // The markers' box in the image with that reach about each; not where one has no pixel.
  bool in_view = false;
  Vector2 low_px = Vector2::Zero(), high_px = Vector2::Zero();

  // Of the place of a marker this far from the middle, in the tool's axes.
  [[nodiscard]] Matrix3 place_covariance(const Vector3& from_middle_m) const {
    const Eigen::Matrix<double, 3, 6> j = point_by_pose(T_camera_tool.rotation * from_middle_m);
    return j * covariance * j.transpose();
  }
};
struct Predictions {
  std::array<Prediction, k_tools_max> tools;
  std::array<Vector2, k_tools_max * k_markers_per_tool_max> markers_px;
  int marker_count = 0;
  bool everywhere = false;  // a tool of the set may be anywhere: the whole frame is searched
  // The whole frame had more runs than the budget: a part of it is searched, another each turn.
  bool narrowed = false;
  std::uint32_t turn = 0;  // number of the accepted frame
  NoiseEstimate noise;     // of the markers, as the frames before showed it
};

struct ToolLabelings {
  std::array<Labelings, k_tools_max> tools;
};

// One labeling for each tool, no marker given twice.
struct Assignment {
  std::array<Labeling, k_tools_max> labeling;
  // The next one of as many markers that puts the tool elsewhere; count 0: there is none.
  std::array<Labeling, k_tools_max> rival;
  std::array<Reason, k_tools_max> reason{};  // none: labeling holds
};

// Of each tool without a labeling, the one or two markers that can only be its own.
struct SeenFew {
  std::array<FewMarkers, k_tools_max> tools;
};

// The pose of each tool in this frame.
struct FittedTool {
  Reason reason = Reason::no_frame_yet;
  std::uint8_t marker_mask = 0;
  double rms_m = 0;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // of the tip, about the camera's axes: the random part
  SystematicCovariance systematic;       // of the markers' middle, about the camera's axes
  double odds = k_odds_most;  // against the likeliest pose that is far from it (expected_pose.hpp)
  bool turned = false;        // it is not the motion that was followed
  bool by_rival = false;      // its markers are named as the assignment's rival has them
  [[nodiscard]] bool ambiguous() const { return odds < k_odds_least; }
  // What few markers tell a filter that expected the tool (agreed_pose.hpp): not a pose to show.
  bool tells_near = false;
  Pose near_T_camera_tool;
  Matrix6 near_covariance = Matrix6::Zero();  // of the markers' middle
  MarkerResiduals residuals;
};
struct FittedTools {
  std::array<FittedTool, k_tools_max> tools;
};
[[nodiscard]] inline const Labeling& labeling_of(const Assignment& assignment,
                                                 const FittedTool& fitted, std::size_t tool) {
  return fitted.by_rival ? assignment.rival[tool] : assignment.labeling[tool];
}

// The frame at the middle of a tool's markers, as the camera saw it, with its covariance about the
// camera's axes: there shift and rotation are measured nearly apart.
[[nodiscard]] inline UncertainPose middle_of(const FittedTool& found, const Tool& tool, Time time) {
  const Pose& seen = found.T_camera_tool;
  const Vector3 middle = tool.middle_m();
  return {time,
          {seen.rotation, seen * middle},
          moved_covariance(found.covariance, seen.rotation * (middle - tool.tip_m))};
}
// As a filter is told of it.
[[nodiscard]] inline UncertainPose told_middle_of(const FittedTool& found, const Tool& tool,
                                                  Time time) {
  if (!found.tells_near) return middle_of(found, tool, time);
  const Pose& near = found.near_T_camera_tool;
  return {time, {near.rotation, near * tool.middle_m()}, found.near_covariance};
}

// The head's pose in this frame as the reference body corrects it, and what is known for the next.
struct Anchor {
  std::uint32_t body = 0;  // the reference tool's identity
  HeadAnchor state;
  AnchoredHead now;
  Pose T_world_reference;  // of the reference tool's own frame, once state.known()
};

// A tool's motion up to this frame, of the middle of its markers.
struct FollowedTool {
  Reason reason = Reason::no_frame_yet;  // why this frame did not move it on
  MotionTrack motion;
  MotionState estimate;                             // motion's, once it is known
  NoiseScale noise;                                 // motion's
  Matrix6 correlated_covariance = Matrix6::Zero();  // beside estimate's
  ReferenceFrame base = ReferenceFrame::camera;
  std::uint32_t identity = 0;  // of the tool that it is of
  std::uint8_t few_mask = 0;   // one or two markers moved it on in place of a pose: which; 0: none
  bool stands = false;         // its pose is sure enough to be called measured
  bool ambiguous = false;      // another is nearly as likely
  bool filtered = false;  // the pose to show is the filter's: the markers alone show too little
  bool in_use = false;    // else it is as it was made
};
// Of one slice: tool t is number t / k_tool_slices.
struct FollowedTools {
  std::array<FollowedTool, k_tools_per_slice> items;
};

// What is known of a tool after a frame: its newest pose and the one before, from which velocity
// follows. `base` is the frame both are in: the world, or the camera where no head pose was valid.
// A pose that rests on one or two markers is the newest like any other, as long as it is sure
// enough (FollowMotion); its mask has no more, and the reason says why there are no more.
struct Track {
  bool alive = false;                    // a pose younger than lost_after exists
  bool filtered = false;                 // the newest is the filter's: the markers tell too little
  bool doubted = false;                  // which never was told from another: it is not given out
  bool seen_now = false;                 // this frame gave it, by three markers or more
  bool has_previous = false;             // `previous` is in the same base and recent enough
  Reason reason = Reason::no_frame_yet;  // why this frame gave none
  ReferenceFrame base = ReferenceFrame::camera;
  std::uint8_t marker_mask = 0;
  std::uint64_t frame_sequence = 0;
  Duration stamp_sigma;          // of newest.time, as the frame stated it
  std::uint32_t identity = 0;    // of the tool that it is of
  double rms_m = 0;              // of the newest that three markers or more gave
  StampedPose newest, previous;  // T_base_tool
  Pose T_camera_tool;            // the newest, as the camera saw it
  MotionState motion;  // T_base_middle (of its markers) and how it changes, not before newest.time
  NoiseScale noise;    // of what the hand does next, as motion's filter has it
  double odds = k_odds_most;  // of that motion against another (expected_pose.hpp)
  double surprise = 1;  // variance of the newest measurement beside what was foretold; 1: no more
  // What the headset's own error, calibration errors and correlated errors add to motion's
  // covariance, about the same point and axes.
  Matrix6 head_covariance = Matrix6::Zero();
  Matrix6 calibration_covariance = Matrix6::Zero();
  Matrix6 correlated_covariance = Matrix6::Zero();
};

// Where a tool's tip is.
struct TipPlace {
  Vector3 arm_m = Vector3::Zero();  // from the markers' middle, along the tool's axes
  double sigma_m = 0;               // an axis

  // Of the tip: of the markers' middle, about the axes that `turn` takes the tool's to.
  [[nodiscard]] Matrix6 systematic_of(const Matrix6& of_middle, const Quaternion& turn) const {
    Matrix6 covariance = moved_covariance(of_middle, turn * arm_m);
    covariance.diagonal().head<3>().array() += sigma_m * sigma_m;
    return covariance;
  }
};
[[nodiscard]] inline TipPlace tip_of(const Tool& tool) {
  return {tool.tip_m - tool.middle_m(), tool.tip_sigma_m};
}

// The frame group's result.
struct Estimates {
  FrameVerdict verdict;
  int tool_count = 0;
  std::array<TipPlace, k_tools_max> tips;  // the tick group needs no tool set
  bool reference_known = false;
  Pose T_world_reference;  // where the reference tool is
  NoiseEstimate noise;     // of the markers
  std::array<Track, k_tools_max> tracks;
};

// The tick's nominal release: the only clock that the output ever sees.
struct Now {
  Time tick;
  std::uint64_t number = 0;
  std::int64_t unix_offset_ns = 0;  // added to a Time it gives nanoseconds since 1970 (UTC)
};

// Where the robot's base is in the headset's world.
struct RobotFrame {
  RegistrationState state = RegistrationState::none;
  Pose T_world_robot;
  double rms_m = 0;
  bool in_reference = false;  // T_world_robot leads to the reference body's frame, not the world's
};

// Which of the pen's buttons are held, in the bits of PoseSample::buttons.
//
// The formats have three bits and leave their order open: it is that of the buttons themselves
// (platform/record/button_event.hpp) and of the CAN frame that may bring them. The fourth, finish,
// ends a path in the program that draws it and is nobody else's matter. No button names a tool:
// they are the first one's, which topics call the pen and a path is drawn with unless told
// otherwise.
struct PenButtons {
  std::uint8_t held = 0;

  // As that tool's samples say it.
  [[nodiscard]] constexpr std::uint8_t of_tool(int tool) const {
    return tool == 0 ? held : std::uint8_t{0};
  }
};

struct PoseSamples {
  std::array<PoseSample, k_tools_max> items;
  int count = 0;
  bool any_frame = false;  // the frame group has published estimates
  Time newest_frame;       // arrival of the frame that they rest on
};

}  // namespace glint
