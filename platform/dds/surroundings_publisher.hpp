// A map, what it leaves free, and a drawn path, for whoever listens, now or later.
//
// Everything is reliable and transient_local: a listener that comes later gets it, too, as long as
// this lives. A cloud goes in messages of at most 64 kB, all with one stamp: larger ones break up
// on the way over a wireless network. A listener that wants all of them keeps as many as there are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/motion/motion_state.hpp"
#include "platform/dds/participant.hpp"

namespace glint {

inline constexpr std::size_t k_cloud_message_bytes = std::size_t{64} << 10;
inline constexpr int k_cloud_messages_max = 1024;  // 2.8 million points with normals

using FloatTriples = std::span<const std::array<float, 3>>;

class SurroundingsPublisher {
 public:
  // Throws as Participant does.
  explicit SurroundingsPublisher(const DdsSettings& settings);

  // sensor_msgs/PointCloud2 on rt/PREFIX/map_points: float32 x, y, z, and normal_x, normal_y,
  // normal_z where there are as many normals as points. Gives how many points were left out, beyond
  // k_cloud_messages_max. Once.
  std::size_t publish_cloud(FloatTriples points, FloatTriples normals, Time unix_time);

  // octomap_msgs/Octomap on rt/PREFIX/octomap; `data` as Occupancy::message_bytes() has it. In one
  // message: the type cannot be divided. Throws InputError beyond 16 MiB. Once.
  void publish_octomap(std::span<const std::int8_t> data, double resolution_m, Time unix_time);

  // nav_msgs/Path on rt/PREFIX/path: T_robot_tip with each point's own time. Once.
  void publish_path(std::span<const UncertainPose> points, Duration unix_minus_board,
                    Time unix_time);

  // tf_static: world to robot and whatever else stands still, all in one message. Once.
  void publish_static(std::span<const StaticTransform> transforms, Time unix_time);

  // How many listeners the topic that has fewest has found.
  [[nodiscard]] int listeners() const;
  // Waits until all of them have everything, at most so long. False: not all do.
  bool wait_for_receipts(Duration limit) const;

 private:
  dds_entity_t add_writer(const TopicType& type, const std::string& topic, int depth);
  void write(dds_entity_t writer, const void* message, const std::string& what);

  DdsSettings settings_;
  Participant participant_;
  std::vector<dds_entity_t> writers_;
};

}  // namespace glint
