// Motion of a drawn tool in hindsight: the smoothed pose of its tip at any time between measured
// frames, with a covariance that contains the errors that frames share.
//
// The random part of the covariance is the smoother's. Errors of the headset, the calibration, the
// clocks and the robot's pose, and correlated errors of the camera are common to many frames: they
// are added afterwards, as in the live output (nodes/predict_tools).
#pragma once

#include <vector>

#include "kernels/path/smooth_stroke.hpp"
#include "platform/tools/programming/measured_frames.hpp"

namespace glint {

struct SmoothedMotionSettings {
  MotionSettings motion;
  Matrix6 robot_covariance = Matrix6::Zero();
  Duration margin = milliseconds(500);  // frames before and after a stroke that are used, too
  // The motion is interpolated between two frames up to this gap if the camera delivered no frame
  // between them, ..
  Duration slow_gap_max = milliseconds(250);
  // .. and up to this one if it delivered frames that do not show the tool.
  Duration hidden_gap_max = milliseconds(100);
};

class SmoothedMotion {
 public:
  // The frames must outlive this object.
  SmoothedMotion(const std::vector<MeasuredFrame>& frames, const SmoothedMotionSettings& settings);

  // Smooths the frames of [from, to] and of the margins. Throws InputError for more than
  // k_stroke_frames_max frames.
  void select(Time from, Time to);

  // Writes the tip's pose at the sample's tick, as measured. Returns false outside of the selected
  // frames and in a gap; the sample is then not changed.
  [[nodiscard]] bool write(PoseSample& sample) const;

  // Frames of all selections, without margins.
  [[nodiscard]] std::int64_t frames_used() const { return frames_used_; }

 private:
  struct Segment {
    std::vector<StrokeFrame> frames;
    std::size_t first = 0;  // in frames_
    std::vector<SmoothedFrame> memory;
    StrokeSmoother smoother;
  };
  [[nodiscard]] bool continues(std::size_t frame) const;
  void smooth(std::size_t begin, std::size_t end);

  const std::vector<MeasuredFrame>& frames_;
  SmoothedMotionSettings settings_;
  std::vector<Segment> segments_;
  std::int64_t frames_used_ = 0;
};

}  // namespace glint
