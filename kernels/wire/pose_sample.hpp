// Output sample of one tool at one tick: all fields of the CAN and DDS output, with their quality.
//
// output_record.hpp defines its byte layout, which output_sha256 hashes.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/reason.hpp"
#include "kernels/units.hpp"

namespace glint {

enum class TrackState : std::uint8_t { none = 0, predicted = 1, measured = 2, lost = 3 };
enum class RegistrationState : std::uint8_t { none = 0, given = 1, accepted = 2, refused = 3 };
enum class ReferenceFrame : std::uint8_t { camera = 0, world = 1, robot = 2 };

// The pen's buttons in the output: bit 0 draw, 1 delete_last, 2 undo.
inline constexpr unsigned k_buttons_mask = 7;

struct PoseSample {
  Time tick;         // nominal release of the tick
  Time measurement;  // mid-exposure of the frame that the pose is based on
  std::uint64_t tick_number = 0;
  std::uint64_t frame_sequence = 0;
  std::uint8_t tool = 0;
  std::uint8_t marker_mask = 0;  // bit i: the tool's marker i was used
  std::uint8_t buttons = 0;      // held, see k_buttons_mask
  TrackState state = TrackState::none;
  RegistrationState registration = RegistrationState::none;
  ReferenceFrame frame = ReferenceFrame::camera;
  Reason reason = Reason::no_frame_yet;
  // Without a pose (state none or lost) the fields below are zero, the rotation identity.
  Pose pose;                               // T_frame_tip: the tool's axes, origin at its tip
  Vector3 velocity_m_s = Vector3::Zero();  // of the tip, in `frame`
  Vector3 angular_velocity_rad_s = Vector3::Zero();
  Matrix6 covariance = Matrix6::Zero();  // x,y,z [m], rotation about fixed axes x,y,z [rad]: total
  Matrix6 systematic = Matrix6::Zero();  // its part by systematic (calibration) errors
  double sigma_position_m = 0;           // per axis: square root of trace / 3 of the position block
  double sigma_orientation_rad = 0;      // likewise for the rotation block
  double registration_rms_m = 0;
  double age_sigma_s = 0;  // of `measurement`; not in the output record

  [[nodiscard]] bool has_pose() const {
    return state == TrackState::predicted || state == TrackState::measured;
  }
  [[nodiscard]] Duration age() const { return tick - measurement; }
};

}  // namespace glint
