// Tracks the pen in frames that this program holds in memory, and decodes its pose from CAN frames.
#include <cstdio>
#include <glint/kernels/wire/can_decode.hpp>
#include <glint/platform/runtime/session/pipeline.hpp>
#include <memory>

#include "drawn_frame.hpp"

namespace {

using namespace glint;

// A receiver's view: the frames alone, selected by their identifier.
void print_pose(const Cell& cell, const CanFrames& frames) {
  CanAddress address;
  address.base = cell.can.base_id;
  const std::uint32_t position = identifier_of(can_message("Position"), address, 0);
  for (const CanFrame& frame : frames.frames()) {
    if (frame.identifier != position) continue;
    if (const auto decoded = decode_position(frame); decoded && decoded.value.valid) {
      const Vector3 tip_mm = 1000 * decoded.value.position_m;
      std::printf("CAN 0x%03x: tip %.1f %.1f %.1f mm\n", frame.identifier, tip_mm.x(), tip_mm.y(),
                  tip_mm.z());
    }
  }
}

}  // namespace

int main() {
  const Cell cell = default_cell();  // or load_cell("cell.toml")
  const auto tracker = std::make_unique<Tracker>();
  const auto output = std::make_unique<Output>();
  configure(cell, *tracker);
  configure(cell, *output);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);

  DrawnFrame drawn(cell.camera);
  Pose T_camera_tool;
  for (std::uint64_t n = 1; n <= 10; ++n) {
    const Time time = Time{} + cell.camera.period * static_cast<std::int64_t>(n);
    T_camera_tool.translation = Vector3(0.02, -0.03, 0.3 + 0.002 * static_cast<double>(n));
    tracker->input<Frame>() = drawn.draw(cell.tools.items[0], T_camera_tool, time, n);
    tracker->input<HeadPose>() = {};  // none: poses are in the camera's frame
    tracker->activate();

    const Estimates& estimates = tracker->output<Estimates>();
    output->latest<Estimates>().set(estimates, n, time.nanoseconds);
    output->input<Now>() = {time, n};
    output->activate();
    print_pose(cell, output->output<CanFrames>());
  }
  const PoseSample& sample = output->output<PoseSamples>().items[0];
  const Vector3& tip = sample.pose.translation;
  std::printf("last tip %.17g %.17g %.17g m, sigma %.17g m\n", tip.x(), tip.y(), tip.z(),
              sample.sigma_position_m);
  return sample.state == TrackState::measured ? 0 : 1;
}
