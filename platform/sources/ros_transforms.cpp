#include "platform/sources/ros_transforms.hpp"

#include <algorithm>

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {
namespace {

constexpr std::uint32_t k_transforms_a_message_max = 4096;

}  // namespace

void add_ros_transforms(std::span<const std::uint8_t> message, bool fixed, TransformTree& to) {
  CdrReader from(message);
  const std::uint32_t count = std::min(from.get<std::uint32_t>(), k_transforms_a_message_max);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Time time = stamp_of(from);
    const std::string_view parent = from.get_text_view(), child = from.get_text_view();
    const Pose pose = get_pose(from);
    if (from.failed()) return;
    to.add(parent, child, time, pose, fixed);
  }
}

std::string_view add_ros_pose(std::span<const std::uint8_t> message, std::string_view child,
                              TransformTree& to) {
  CdrReader from(message);
  const Time time = stamp_of(from);
  const std::string_view frame = from.get_text_view();
  const Pose pose = get_pose(from);
  if (from.failed()) return {};
  to.add(frame, child, time, pose, false);
  return frame;
}

}  // namespace glint
