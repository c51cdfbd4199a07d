// Tokens of the tracking graph: the value types passed between nodes, beyond the kernels' own types
// (Frame, Rois, Runs, Blobs, Markers, ToolSet, HeadPose).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/limits.hpp"
#include "kernels/motion/head_drift_correction.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_track.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/expected_pose.hpp"
#include "kernels/pose/labeling.hpp"
#include "kernels/pose/noise_estimate.hpp"
#include "kernels/pose/partial_visibility.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/reason.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

// Number of partitions of the tools; independent of the number of workers.
inline constexpr int k_tool_partitions = 4;
inline constexpr int k_tools_per_partition =
    (k_tools_max + k_tool_partitions - 1) / k_tool_partitions;

// Metadata of a frame, without its pixels.
struct FrameStamp {
  Time mid_exposure;
  Duration sigma;  // standard deviation of mid_exposure, as stated by the frame
  Time arrival;
  std::uint64_t sequence = 0;
  Reason reason = Reason::none;  // frame_invalid: wrong size, or a plane is missing
};

// Result of frame validation for this activation, with the counters of rejected frames.
struct FrameVerdict {
  FrameStamp stamp;
  Reason reason = Reason::none;  // frame_late, frame_duplicate, frame_invalid
  bool resynchronised = false;   // the time stamps restarted: earlier tracks are invalid
  std::uint64_t accepted = 0;    // counters since the start
  std::uint64_t late = 0, doubled = 0, invalid = 0, resynchronisations = 0;
  [[nodiscard]] bool usable() const { return reason == Reason::none; }
};

// Predicted pose of a tool at this frame's mid-exposure.
struct Prediction {
  bool has_prior = false;
  bool undetected_last = false;  // the last frame did not detect it: search the whole frame
  Pose T_camera_tool;
  double reach_m = 0;  // search radius of the tool's markers about the prediction
  // True if the prediction comes from the filtered motion. Only then does `covariance` hold: of the
  // centroid of the tool's markers, about the camera's axes. Otherwise the tool keeps its last pose
  // in the camera frame.
  bool follows_motion = false;
  bool within_reach_only = false;  // the speed is estimated too: no marker of it is beyond reach_m
  double odds = k_odds_max;        // of that motion against the next likeliest (expected_pose.hpp)
  Matrix6 covariance = Matrix6::Zero();
  // Bounding box of the markers in the image, each dilated by that reach. Invalid where a marker
  // has no pixel.
  bool in_view = false;
  Vector2 low_px = Vector2::Zero(), high_px = Vector2::Zero();

  // Position covariance of a marker at `from_centroid_m` from the marker centroid, in the tool
  // frame.
  [[nodiscard]] Matrix3 marker_position_covariance(const Vector3& from_centroid_m) const noexcept
      GLINT_NONBLOCKING;
};
struct Predictions {
  std::array<Prediction, k_tools_max> tools;
  std::array<Vector2, k_tools_max * k_markers_per_tool_max> markers_px;
  int marker_count = 0;
  bool search_whole_frame = false;  // a tool may be anywhere: the whole frame is searched
  // The whole frame exceeded the run budget: search one part of it, a different part each frame.
  bool search_part_of_frame = false;
  std::uint32_t frame_number = 0;  // number of the accepted frame
  NoiseEstimate noise;             // of the markers, estimated from earlier frames
};

struct ToolLabelings {
  std::array<Labelings, k_tools_max> tools;
};

// One labeling per tool; no marker is assigned to two tools.
struct Assignment {
  std::array<Labeling, k_tools_max> labeling;
  // The alternative labeling: the next one of equally many markers with a distinctly different
  // pose. count 0: none exists.
  std::array<Labeling, k_tools_max> alternative;
  std::array<Reason, k_tools_max> reason{};  // none: labeling holds
};

// For each tool without a labeling: the one or two visible markers that can belong to no other.
struct SeenFew {
  std::array<PartialMarkers, k_tools_max> tools;
};

// Pose of a tool fitted to this frame's markers.
struct FittedTool {
  Reason reason = Reason::no_frame_yet;
  std::uint8_t marker_mask = 0;
  double rms_m = 0;
  Pose T_camera_tool;
  Matrix6 covariance = Matrix6::Zero();  // random part: of the tip, about the camera's axes
  SystematicCovariance systematic;       // of the marker centroid, about the camera's axes
  double odds = k_odds_max;  // against the likeliest distinct pose hypothesis (expected_pose.hpp)
  bool contradicts_track = false;  // it contradicts the tracked motion, which is then restarted
  bool by_alternative = false;     // its labeling is the assignment's alternative labeling
  [[nodiscard]] bool ambiguous() const { return odds < k_odds_min; }
  // Measurement relinearised at the prediction, for the filter only (map_pose.hpp): never
  // published as a pose.
  bool has_relinearised = false;
  Pose relinearised_T_camera_tool;
  Matrix6 relinearised_covariance = Matrix6::Zero();  // of the marker centroid
  MarkerResiduals residuals;
};
struct FittedTools {
  std::array<FittedTool, k_tools_max> tools;
};
[[nodiscard]] inline const Labeling& labeling_of(const Assignment& assignment,
                                                 const FittedTool& fitted, std::size_t tool) {
  return fitted.by_alternative ? assignment.alternative[tool] : assignment.labeling[tool];
}

// Pose of the centroid of a tool's markers in the camera frame, with its covariance about the
// camera's axes. At the centroid, translation and rotation are nearly uncorrelated.
[[nodiscard]] UncertainPose centroid_pose_of(const FittedTool& found, const Tool& tool,
                                             Time time) noexcept GLINT_NONBLOCKING;
// The same pose as input to the motion filter: the relinearised measurement where there is one.
[[nodiscard]] UncertainPose filter_measurement_of(const FittedTool& found, const Tool& tool,
                                                  Time time) noexcept GLINT_NONBLOCKING;

// Head pose of this frame after drift correction by the reference body, and the state for the next
// frame.
struct Anchor {
  std::uint32_t body = 0;  // identity of the reference tool
  HeadDriftCorrection state;
  CorrectedHead now;
  Pose T_world_reference;  // of the reference tool's own frame; valid once state.known()
};

// Motion state of a tool after this frame, of the centroid of its markers.
struct TrackedTool {
  Reason reason = Reason::no_frame_yet;  // why this frame did not update it
  MotionTrack motion;
  MotionState estimate;                             // motion's estimate, once it exists
  NoiseScale noise;                                 // motion's
  Matrix6 correlated_covariance = Matrix6::Zero();  // to be added to estimate's covariance
  ReferenceFrame base = ReferenceFrame::camera;
  std::uint32_t identity = 0;     // of the tool it belongs to
  std::uint8_t partial_mask = 0;  // the one or two markers that updated it without a pose; 0: none
  bool is_publishable = false;    // the pose is precise enough to be published as measured
  bool ambiguous = false;         // an alternative is nearly as likely
  // Publish the filter's pose: the markers alone are too imprecise, or in doubt between minima.
  bool use_filter_pose = false;
  bool in_use = false;  // otherwise default-constructed
};
// One partition: tool t has index t / k_tool_partitions.
struct FollowedTools {
  std::array<TrackedTool, k_tools_per_partition> items;
};

// Track of a tool after a frame: its newest pose and the one before, which together define the
// velocity. `base` is the frame of both: the world, or the camera if no head pose was valid. The
// newest pose may come from one or two visible markers, if it is precise enough (FollowMotion).
// Then marker_mask holds only these, and `reason` states why there are no more.
struct Track {
  bool alive = false;           // a pose younger than lost_after exists
  bool is_filter_pose = false;  // `newest` is the filter's pose, not the markers' own
  bool unconfirmed = false;     // not yet both unambiguous and precise: not published
  bool measured_now = false;    // this frame gave a measured pose of at least three markers
  bool has_previous = false;    // `previous` is in the same base and recent enough
  Reason reason = Reason::no_frame_yet;  // why this frame gave no measured pose
  ReferenceFrame base = ReferenceFrame::camera;
  std::uint8_t marker_mask = 0;
  std::uint64_t frame_sequence = 0;
  Duration stamp_sigma;        // standard deviation of newest.time, as stated by the frame
  std::uint32_t identity = 0;  // of the tool it belongs to
  double rms_m = 0;            // of the newest pose fitted to at least three markers
  TimedPose newest, previous;  // T_base_tool
  Pose T_camera_tool;          // the newest pose in the camera frame
  MotionState motion;  // T_base_middle (marker centroid), derivatives; at newest.time or later
  NoiseScale noise;    // process noise scale of the motion filter
  double odds = k_odds_max;  // of that motion against the next likeliest (expected_pose.hpp)
  double nis_ratio = 1;      // NIS of the newest measurement over its dimension, at least 1
  // Covariances to be added to motion's, about the same point and axes: of the headset's
  // localisation error, of the calibration errors, and of the correlated errors.
  Matrix6 head_covariance = Matrix6::Zero();
  Matrix6 calibration_covariance = Matrix6::Zero();
  Matrix6 correlated_covariance = Matrix6::Zero();
};

// Position of a tool's tip relative to the centroid of its markers.
struct TipPosition {
  Vector3 arm_m = Vector3::Zero();  // from the marker centroid, in the tool frame
  double sigma_m = 0;               // standard deviation, an axis

  // Systematic covariance of the tip from that of the marker centroid. `axes_rotation` rotates the
  // tool's axes to the covariance's axes.
  [[nodiscard]] Matrix6 systematic_of(
      const Matrix6& of_middle, const Quaternion& axes_rotation) const noexcept GLINT_NONBLOCKING;
};
[[nodiscard]] inline TipPosition tip_of(const Tool& tool) {
  return {tool.tip_m - tool.middle_m(), tool.tip_sigma_m};
}

// Output of the frame group.
struct Estimates {
  FrameVerdict verdict;
  int tool_count = 0;
  std::array<TipPosition, k_tools_max> tips;  // so that the tick group needs no tool set
  bool has_reference = false;
  Pose T_world_reference;  // pose of the reference tool
  NoiseEstimate noise;     // of the markers
  std::array<Track, k_tools_max> tracks;
};

// Nominal release of the tick: the only clock that the output group reads.
struct Now {
  Time tick;
  std::uint64_t number = 0;
  std::int64_t unix_offset_ns = 0;  // Time + this = nanoseconds since 1970 (UTC)
};

// Pose of the robot's base in the headset's world.
struct RobotFrame {
  RegistrationState state = RegistrationState::none;
  Pose T_world_robot;
  double rms_m = 0;
  bool in_reference = false;  // T_world_robot leads to the reference body's frame
};

// Pen buttons that are held, in the bits of PoseSample::buttons.
//
// The formats define three bits and leave their order open. The order here is that of
// button_event.hpp (platform/sinks/record) and of the CAN frame that may carry them. A fourth
// button, finish, ends a path in the drawing program and is not published here. Buttons carry no
// tool number: they belong to tool 0, which the topics call the pen and which draws paths by
// default.
struct PenButtons {
  std::uint8_t held = 0;

  // Buttons published in that tool's samples.
  [[nodiscard]] constexpr std::uint8_t of_tool(int tool) const {
    return tool == 0 ? held : std::uint8_t{0};
  }
};

struct PoseSamples {
  std::array<PoseSample, k_tools_max> items;
  int count = 0;
  bool any_frame = false;  // the frame group has published estimates
  Time newest_frame;       // arrival time of the newest frame used
};

}  // namespace glint
