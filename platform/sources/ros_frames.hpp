// ROS 2's messages as they arrive, made into a live source's frames: images are checked, paired by
// their stamps, given their head pose and handed over in order.
//
// No heap after the constructor for a message that is taken, but for a transform's first (see
// TransformTree); a refusal takes some for its text.
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

// A frame whose transforms are on their way waits for them, at most so many nominal gaps.
inline constexpr int k_pose_wait_gaps = 2;
// An image of another publisher is taken once the topic's own has been silent for this long: more
// than a camera's longest gap, less than another process takes to start.
inline constexpr Duration k_publisher_silent = milliseconds(300);

class RosFrames {
 public:
  // `source`: its topics and world_frame. The head pose is T_world_camera: of the pose topic, or of
  // tf from the world_frame to the images' frame; there is none where neither is named.
  RosFrames(LiveSource& frames, const SourceSettings& source);

  // `publisher`: any number of its own. `arrival`: monotonic.
  void take_image(std::span<const std::uint8_t> message, ImageKind kind, std::uint64_t publisher,
                  Time arrival);
  void take_transforms(std::span<const std::uint8_t> message, bool fixed);
  void take_pose(std::span<const std::uint8_t> message);
  // A message that is refused unread: how, and what was expected.
  void refuse(const std::string& why);

  // Hands over the frames that wait for nothing more.
  void hand_over(Time now);
  // When hand_over() is due though nothing arrives; far away: never.
  [[nodiscard]] Time due() const;
  [[nodiscard]] std::uint64_t publishers() const { return publishers_; }
  void add_to(SourceReport& report) const;

 private:
  struct Image {
    Time stamp, arrival;
    std::string frame;                  // with room for k_frame_name_max
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
  std::string pose_topic_, world_;  // empty: none, and not known
  std::uint64_t publishers_ = 0, foreign_ = 0, refused_ = 0, unpaired_ = 0, poses_late_ = 0,
                poses_broken_ = 0;
  std::string first_refusal_;
};

}  // namespace glint
