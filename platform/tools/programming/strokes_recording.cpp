#include "platform/tools/programming/strokes_recording.hpp"

#include <algorithm>

#include "platform/input_error.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "platform/sinks/record/schemas.hpp"
#include "platform/sinks/record/topics.hpp"

namespace glint {
namespace {

constexpr const char* k_stroke_type = "glint_msgs/msg/Stroke";

void write_stroke(CdrWriter& to, const PathElement& element, Duration unix_offset) {
  to.begin();
  put_header(to, element.points.front().time + unix_offset, k_robot_frame);
  to.put(element.name);
  to.put(static_cast<std::uint8_t>(element.kind));
  to.put_length(element.points.size());
  for (const UncertainPose& point : element.points) {
    put_header(to, point.time + unix_offset, k_robot_frame);
    put_pose(to, point.pose);
    for (int i = 0; i < 36; ++i) to.put(point.covariance(i / 6, i % 6));
  }
}

}  // namespace

void write_strokes_recording(const std::string& file, const StrokesFile& strokes) {
  McapWriter mcap(file, "ros2", "glint");
  const std::uint16_t channel =
      mcap.add_channel(std::string(k_stroke_topic), k_stroke_type, schema_text(k_stroke_type),
                       {{"offered_qos_profiles", ""}});
  CdrWriter cdr;
  std::uint32_t sequence = 0;
  for (const PathElement& element : strokes.path) {
    write_stroke(cdr, element, strokes.unix_offset);
    const Time end = element.points.back().time + strokes.unix_offset;
    const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(0, end.nanoseconds));
    mcap.write({channel, sequence++, time, time}, cdr.bytes());
  }
  if (!mcap.close("glint", {{"tool", strokes.tool}}))
    throw InputError(file + ": cannot be written: " + mcap.error());
}

}  // namespace glint
