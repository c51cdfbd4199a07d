// Messages for a headset's display, in Unity's axes: each pen, the robot, the newest strokes.
//
// A message has a slot. Its contents are the newest; its version rises at a limited rate. A slot is
// sent to each client that was not sent this version. README.md: the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/sinks/headset/headset_output.hpp"

namespace glint {

class HeadsetMessages {
 public:
  static constexpr std::size_t k_strokes_max = 16;         // later ones replace the oldest
  static constexpr std::size_t k_stroke_points_max = 512;  // then every second point is removed
  static constexpr double k_point_gap_m = 0.002;           // of a stroke, at first
  static constexpr Duration k_pen_period{33'333'333};
  static constexpr Duration k_stroke_period = milliseconds(100);
  static constexpr Duration k_robot_period = milliseconds(1000);
  static constexpr std::size_t k_slots = k_tools_max + 1 + k_strokes_max;

  explicit HeadsetMessages(std::vector<std::string> tool_names);

  // Requires rising ticks of each tool. No heap except for a stroke's first points.
  void add(const HeadsetSample& given);
  // Raises the versions that are due, each by one. Call after the samples that have arrived.
  void publish_due();

  // 0: the slot has no message.
  [[nodiscard]] std::uint64_t version(std::size_t slot) const { return slots_[slot].version; }
  // JSON; ages are those at the newest tick.
  [[nodiscard]] std::string text(std::size_t slot) const;

 private:
  struct Slot {
    std::uint64_t version = 0;
    bool is_due = false;
    Time due;  // the last time
  };
  struct Stroke {
    std::uint64_t id = 0;
    bool done = false;
    double gap_m = k_point_gap_m;
    Time newest;                  // measurement of its last point
    std::vector<Vector3> points;  // in the world
  };

  void mark(std::size_t slot, Duration period, bool at_once);
  void add_robot(const RobotFrame& robot);
  void add_to_stroke(const PoseSample& sample);
  [[nodiscard]] std::string pen_text(const HeadsetSample& pen) const;
  [[nodiscard]] std::string robot_text() const;
  [[nodiscard]] std::string stroke_text(const Stroke& stroke) const;

  std::vector<std::string> tool_names_;
  std::array<Slot, k_slots> slots_{};
  std::vector<HeadsetSample> pens_;
  Time newest_;
  RobotFrame robot_;
  Time robot_changed_;
  std::array<Stroke, k_strokes_max> strokes_;
  std::uint64_t strokes_begun_ = 0;
  bool drawing_ = false;
};

}  // namespace glint
