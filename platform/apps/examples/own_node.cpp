// Tracks the pen, and reads the token of a node that is not Glint's.
#include "own_node.hpp"

#include <cstdio>
#include <glint/platform/runtime/session/pipeline.hpp>
#include <memory>

#include "drawn_frame.hpp"

int main() {
  using namespace glint;
  const Cell cell = default_cell();
  const auto tracker = std::make_unique<own::Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);

  DrawnFrame drawn(cell.camera);
  Pose T_camera_tool;
  T_camera_tool.translation = Vector3(0, 0, 0.3);
  tracker->input<Frame>() =
      drawn.draw(cell.tools.items[0], T_camera_tool, Time{} + cell.camera.period, 1);
  tracker->activate();
  const graph::LoopCounts counts = tracker->node<own::FindNearest>().counts();
  std::printf("nearest of %lld markers at %.4f m, pen %s\n", static_cast<long long>(counts[1]),
              tracker->output<own::Nearest>().range_m,
              tracker->output<Estimates>().tracks[0].measured_now ? "measured" : "not measured");
}
