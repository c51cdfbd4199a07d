// One frame of a tool among strays as points, in any order, with the truth and a prior.
#pragma once

#include "kernels/pose/pose_prior.hpp"
#include "platform/lab/experiments/point_view.hpp"

namespace glint {

struct NoisyScene {
  const PointTool& tool;
  ObservationNoise noise;
  int strays = 0;
};

struct NoisyFrame {
  PointView view;
  Pose truth;       // T_camera_tool
  PosePrior prior;  // of the markers' mean; error 10 mm and 5 degrees rms, as stated
};

// Half a metre away, the tool's normal tilted by up to 45 degrees; the strays anywhere in a box of
// half a metre around it, but where their images touch another's, for that would be one blob.
void draw_frame(const NoisyScene& scene, const Camera& camera, SampleNumbers& numbers,
                NoisyFrame& frame);
// The same with this pose of the tool.
void draw_frame(const NoisyScene& scene, const Camera& camera, const Pose& T_camera_tool,
                SampleNumbers& numbers, NoisyFrame& frame);

}  // namespace glint
