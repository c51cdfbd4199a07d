// A camera to trust: frames of a headset's time-of-flight camera with the truth beside them.
//
// What:     ray-traced markers, hands and clutter over a background, then the sensor's noise and
//           limits; head pose by the headset's drifting localisation; a reference tracker.
// Same seed, same bytes, on any machine, in any order, from any thread: render(i) depends on the
//           scenario and i alone.
// Cost:     a few milliseconds a frame; no allocation after the first into the same SimFrame.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "platform/formats/frame_buffer.hpp"
#include "platform/formats/frame_truth.hpp"
#include "platform/sim/planes.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct SimFrame {
  FrameBuffer pixels;
  Time mid_exposure, arrival;  // as stamped
  std::uint64_t sequence = 0;
  HeadPose head;  // by the drifting localisation, at the stamp
  FrameGroundTruth truth;
  std::vector<Pose> reference;  // T_reference_tool, each tool
  Planes scratch, spread;

  [[nodiscard]] Frame view() const { return pixels.view(mid_exposure, arrival, sequence); }
};

class Simulator {
 public:
  explicit Simulator(Scenario scenario);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  // Deliveries, in the order of their arrival; see timing.hpp.
  [[nodiscard]] int frame_count() const;
  [[nodiscard]] FrameTiming timing(int i) const;
  void render(int i, SimFrame& out) const;
  // The same without pixels: stamps, truth but for visible_mask, head pose, reference.
  void describe(int i, SimFrame& out) const;

  [[nodiscard]] Pose truth_tool(int tool, Time time) const;  // T_world_tool
  [[nodiscard]] Pose truth_camera(Time time) const;          // T_world_camera
  [[nodiscard]] const Scenario& scenario() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glint::sim
