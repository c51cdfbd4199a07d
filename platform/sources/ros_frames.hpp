// Converts ROS 2 messages to frames of a live source: checks images, pairs them by time stamp, adds
// the head pose and publishes the frames in order.
//
// No heap after the constructor for accepted messages, except for a transform's first (see
// TransformTree). A refusal allocates its text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/sources/live_source.hpp"
#include "platform/sources/stamp_pairs.hpp"
#include "platform/sources/transform_tree.hpp"

namespace glint {

// Maximum wait of a frame for its transforms, in nominal gaps.
inline constexpr int k_pose_wait_gaps = 2;
// Accepts another publisher after the topic's own is silent for this long: longer than a camera's
// longest gap, shorter than the start of another process.
inline constexpr Duration k_publisher_silent = milliseconds(300);

class RosFrames {
 public:
  // source: topics and world_frame. The head pose T_world_camera is from the pose topic, or from tf
  // between world_frame and the images' frame; none if neither is named.
  RosFrames(LiveSource& frames, const SourceSettings& source);

  // publisher: any unique number. arrival: monotonic clock.
  void add_image(std::span<const std::uint8_t> message, ImageKind kind, std::uint64_t publisher,
                 Time arrival);
  void add_transforms(std::span<const std::uint8_t> message, bool fixed);
  void add_pose(std::span<const std::uint8_t> message);
  // Counts a message that is refused unread. why: found and expected.
  void refuse(const std::string& why);

  // Publishes the oldest frames as long as each has its head pose, cannot get one, or is due.
  void publish_ready(Time now);
  // Time at which publish_ready() is due without a new message; INT64_MAX if no frame waits.
  [[nodiscard]] Time due() const;
  [[nodiscard]] std::uint64_t publishers() const { return publishers_; }
  void add_to(SourceReport& report) const;

 private:
  struct Image {
    Time stamp, arrival;
    std::string frame;                  // reserves k_frame_name_max
    std::vector<std::uint16_t> values;  // of the camera's size
  };
  struct Stream {
    std::string topic;
    std::optional<std::uint64_t> publisher;
    Time newest_arrival, newest_stamp;
  };
  struct Pair {
    Image reflectivity, depth;
    Time mid_exposure, arrival;
  };
  [[nodiscard]] bool is_publisher(Stream& stream, ImageKind kind, std::uint64_t publisher,
                                  Time arrival);
  void read(std::span<const std::uint8_t> message, const Stream& stream, ImageKind kind,
            Image& image) const;
  void pair_up(Image image, ImageKind kind);
  [[nodiscard]] bool may_get_pose(const Pair& pair) const;
  void deliver(Pair& pair);
  [[nodiscard]] std::string_view camera_of(const Pair& pair) const;

  LiveSource& frames_;
  Stream streams_[2];  // by kind
  StampPairs<Image> pairs_;
  std::vector<Image> spare_;
  std::vector<Pair> complete_;  // wait for their head pose, oldest first
  TransformTree transforms_{TransformHistory::newest};
  std::string pose_topic_, world_;  // empty: none; unknown
  std::uint64_t publishers_ = 0, other_publisher_ = 0, refused_ = 0, unpaired_ = 0, poses_late_ = 0,
                poses_incomplete_ = 0;
  std::string first_refusal_;
};

}  // namespace glint
