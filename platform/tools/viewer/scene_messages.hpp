// The scene for viewers, as visualization_msgs/MarkerArray: tools, candidates, the stroke that is
// being drawn.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/limits.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/button_event.hpp"
#include "platform/sinks/record/cdr.hpp"

namespace glint {

inline constexpr std::size_t k_stroke_points_max = 4096;  // then every second one is discarded

class SceneMessages {
 public:
  explicit SceneMessages(const ToolSet& tools) : tools_(tools) {}

  void add(const PoseSample& sample);
  void add(const ButtonEvent& event);
  // Points of a frame's candidates, camera frame.
  void set_candidates(std::vector<Vector3> points) { candidates_ = std::move(points); }

  // Starts the message in the writer; `stamp` is since 1970.
  void write(CdrWriter& to, Time stamp) const;

 private:
  void write_tool(CdrWriter& to, Time stamp, std::size_t tool) const;
  void write_candidates(CdrWriter& to, Time stamp) const;
  void write_stroke(CdrWriter& to, Time stamp) const;
  void add_stroke_point(const PoseSample& sample);

  const ToolSet& tools_;
  std::array<PoseSample, k_tools_max> newest_;
  std::vector<Vector3> candidates_, stroke_;
  ReferenceFrame stroke_frame_ = ReferenceFrame::camera;
  Duration stroke_spacing_ = milliseconds(10);
  Time newest_point_;
  bool draws_ = false;
};

}  // namespace glint
