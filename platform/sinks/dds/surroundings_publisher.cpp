#include "platform/sinks/dds/surroundings_publisher.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/network.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {
namespace {

constexpr std::uint8_t k_float32 = 7;  // sensor_msgs/PointField
// Upper limit of a message's size without its points: names, fields, lengths.
constexpr std::size_t k_heading_bytes = 1024;

template <class Sequence, class Item>
void borrow(Sequence& sequence, std::vector<Item>& items) {
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
  sequence._buffer = items.data();
}

std::vector<PointFieldMessage> fields_of(bool normals) {
  std::vector<PointFieldMessage> fields;
  constexpr const char* names[] = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  const std::size_t count = normals ? 6 : 3;
  for (std::size_t i = 0; i < count; ++i) {
    fields.push_back({borrowed(names[i]), static_cast<std::uint32_t>(4 * i), k_float32, 1});
  }
  return fields;
}

std::vector<std::uint8_t> rows_of(FloatTriples points, FloatTriples normals) {
  const std::size_t step = normals.empty() ? 12 : 24;
  std::vector<std::uint8_t> bytes(points.size() * step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(bytes.data() + i * step, points[i].data(), 12);
    if (!normals.empty()) std::memcpy(bytes.data() + i * step + 12, normals[i].data(), 12);
  }
  return bytes;
}

}  // namespace

MapPublisher::MapPublisher(const DdsSettings& settings)
    : settings_(settings), participant_(settings) {}

dds_entity_t MapPublisher::add_writer(const TopicType& type, const std::string& topic, int depth) {
  const dds_entity_t writer = participant_.writer(
      type, topic, {Reliability::reliable, Durability::transient_local, std::max(1, depth)});
  writers_.push_back(writer);
  return writer;
}

std::string MapPublisher::own_topic(const char* name) const {
  return topic_in(settings_.name, topic_under(settings_.topic_prefix, name));
}

void MapPublisher::write(dds_entity_t writer, const void* message, const std::string& what) {
  const dds_return_t code = dds_write(writer, message);
  if (code != DDS_RETCODE_OK) {
    throw std::runtime_error("dds: " + what + " was not written: " + dds_strretcode(-code));
  }
}

std::size_t MapPublisher::publish_cloud(FloatTriples points, FloatTriples normals, Time unix_time) {
  const bool with_normals = normals.size() == points.size() && !normals.empty();
  const std::uint32_t step = with_normals ? 24 : 12;
  const std::size_t points_per_message = (k_cloud_message_bytes - k_heading_bytes) / step;
  const std::size_t messages_needed = (points.size() + points_per_message - 1) / points_per_message;
  const std::size_t messages = std::min(messages_needed, std::size_t{k_cloud_messages_max});
  const dds_entity_t writer =
      add_writer(cloud_type(), own_topic(k_map_points_name), static_cast<int>(messages));
  std::vector<PointFieldMessage> fields = fields_of(with_normals);
  for (std::size_t i = 0; i < messages; ++i) {
    const std::size_t first = i * points_per_message,
                      count = std::min(points_per_message, points.size() - first);
    std::vector<std::uint8_t> data =
        rows_of(points.subspan(first, count),
                with_normals ? normals.subspan(first, count) : FloatTriples{});
    CloudMessage message{};
    message.header = header_message(unix_time, settings_.frames.world.c_str());
    message.height = 1;
    message.width = static_cast<std::uint32_t>(count);
    borrow(message.fields, fields);
    message.point_step = step;
    message.row_step = message.width * step;
    borrow(message.data, data);
    message.is_dense = true;
    write(writer, &message, "a map's points");
  }
  return points.size() - std::min(points.size(), messages * points_per_message);
}

void MapPublisher::publish_octomap(std::span<const std::int8_t> data, double resolution_m,
                                   Time unix_time) {
  if (data.size() + k_heading_bytes > k_message_bytes_max) {
    throw InputError("octomap: " + std::to_string(data.size()) +
                     " bytes; expected at most 16 MiB in one message: set a coarser resolution");
  }
  const dds_entity_t writer = add_writer(octomap_type(), own_topic(k_octomap_name), 1);
  std::vector<std::int8_t> bytes(data.begin(), data.end());
  OctomapMessage message{};
  message.header = header_message(unix_time, settings_.frames.world.c_str());
  message.binary = true;
  message.id = borrowed("OcTree");
  message.resolution = resolution_m;
  borrow(message.data, bytes);
  write(writer, &message, "an octomap");
}

void MapPublisher::publish_path(std::span<const UncertainPose> points, Duration unix_minus_session,
                                Time unix_time) {
  const dds_entity_t writer = add_writer(path_type(), own_topic(k_path_name), 1);
  const char* const frame = settings_.frames.robot.c_str();
  std::vector<PoseStampedMessage> poses;
  poses.reserve(points.size());
  for (const UncertainPose& point : points) {
    poses.push_back(
        {header_message(point.time + unix_minus_session, frame), pose_message(point.pose)});
  }
  PathMessage message{};
  message.header = header_message(unix_time, frame);
  borrow(message.poses, poses);
  write(writer, &message, "a path");
}

void MapPublisher::publish_static(std::span<const StaticTransform> transforms, Time unix_time) {
  const dds_entity_t writer = add_writer(tf_type(), topic_in(settings_.name, k_tf_static_topic), 1);
  std::vector<TransformMessage> messages;
  for (const StaticTransform& one : transforms) {
    messages.push_back(transform_message(header_message(unix_time, one.parent.c_str()),
                                         one.child.c_str(), one.T_parent_child));
  }
  TfMessage message{};
  borrow(message.transforms, messages);
  write(writer, &message, "tf_static");
}

int MapPublisher::matched_readers() const {
  std::uint32_t readers_min = writers_.empty() ? 0 : UINT32_MAX;
  for (const dds_entity_t writer : writers_) {
    dds_publication_matched_status_t status{};
    if (dds_get_publication_matched_status(writer, &status) != DDS_RETCODE_OK) return 0;
    readers_min = std::min(readers_min, status.current_count);
  }
  return static_cast<int>(readers_min);
}

bool MapPublisher::wait_for_acknowledgements(Duration limit) const {
  const dds_time_t deadline = dds_time() + limit.nanoseconds;
  bool all_acknowledged = true;
  for (const dds_entity_t writer : writers_) {
    const dds_duration_t remaining = std::max<dds_duration_t>(0, deadline - dds_time());
    all_acknowledged = dds_wait_for_acks(writer, remaining) == DDS_RETCODE_OK && all_acknowledged;
  }
  return all_acknowledged;
}

}  // namespace glint
