// DDS publisher of a map's points, its octomap and a drawn path, for present and later readers.
//
// All topics are reliable and transient_local: late readers receive them while this object exists.
// A point cloud is split into messages of at most 64 kB with the same stamp, since larger ones are
// fragmented on wireless networks. To receive all of them, a reader's keep_last depth must be at
// least their number.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "platform/sinks/dds/participant.hpp"

namespace glint {

inline constexpr std::size_t k_cloud_message_bytes = std::size_t{64} << 10;
inline constexpr int k_cloud_messages_max = 1024;  // 2.8 million points with normals

using FloatTriples = std::span<const std::array<float, 3>>;

class MapPublisher {
 public:
  // Throws as Participant does.
  explicit MapPublisher(const DdsSettings& settings);

  // sensor_msgs/PointCloud2 on rt/PREFIX/map_points: float32 x, y, z, and normal_x, normal_y,
  // normal_z if there are as many normals as points. Returns the number of omitted points beyond
  // k_cloud_messages_max. Call once.
  std::size_t publish_cloud(FloatTriples points, FloatTriples normals, Time unix_time);

  // octomap_msgs/Octomap on rt/PREFIX/octomap, in one message, since the type cannot be divided;
  // `data` from Occupancy::message_bytes(). Throws InputError beyond 16 MiB. Call once.
  void publish_octomap(std::span<const std::int8_t> data, double resolution_m, Time unix_time);

  // nav_msgs/Path on rt/PREFIX/path: T_robot_tip with each point's own time. Call once.
  void publish_path(std::span<const UncertainPose> points, Duration unix_minus_session,
                    Time unix_time);

  // tf_static: world to robot and all other static transforms, in one message. Call once.
  void publish_static(std::span<const StaticTransform> transforms, Time unix_time);

  // Number of matched readers; the minimum over all topics.
  [[nodiscard]] int matched_readers() const;
  // Waits at most `limit` for the acknowledgements of all readers; returns false if some are
  // missing.
  bool wait_for_acknowledgements(Duration limit) const;

 private:
  dds_entity_t add_writer(const TopicType& type, const std::string& topic, int depth);
  [[nodiscard]] std::string own_topic(const char* name) const;
  void write(dds_entity_t writer, const void* message, const std::string& what);

  DdsSettings settings_;
  Participant participant_;
  std::vector<dds_entity_t> writers_;
};

}  // namespace glint
