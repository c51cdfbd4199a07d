// Reader of frames from a ROS 2 bag (MCAP) of another program: two image topics, paired by time
// stamp.
//
// Reads the bag twice: first transforms and lenses, then images.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sources/frame_reader.hpp"
#include "platform/sources/ros_images.hpp"
#include "platform/sources/stamp_pairs.hpp"
#include "platform/sources/transform_tree.hpp"

namespace glint {

class RosbagFrames final : public FrameReader {
 public:
  // `source.path`: an MCAP file, or a folder of them in the order of their numbers. Throws
  // InputError that lists the topics: no such topic, or none named and the choice is ambiguous.
  RosbagFrames(const SourceSettings& source, const Camera& camera, ReadTolerance tolerance);

  [[nodiscard]] bool next(ReadFrame& frame) override;
  [[nodiscard]] std::optional<SourceLens> lens() const override;
  [[nodiscard]] std::uint64_t unreadable() const override { return unreadable_; }
  [[nodiscard]] std::string first_unreadable() const override { return first_unreadable_; }
  [[nodiscard]] ReaderCounts counts() const override;
  [[nodiscard]] std::string missing() const override;
  [[nodiscard]] std::string text() const override;
  [[nodiscard]] std::optional<Duration> unix_offset() const override;

 private:
  struct Image {
    RosImage image;
    Time logged;
  };
  struct ImageTopic {
    std::uint64_t count = 0;
    RosHeader first;
    Duration min_delay;  // from a stamp to its log time
  };
  void scan();
  void scan(const McapMessage& message);
  void choose_topics();
  void choose_poses();
  [[nodiscard]] std::optional<McapMessage> next_message();
  [[nodiscard]] bool open_next_file();
  void record_losses();
  [[nodiscard]] Duration min_delay() const;
  [[nodiscard]] Duration declared_delay() const {
    return camera_.transport + Duration{camera_.exposure.nanoseconds / 2};
  }
  [[nodiscard]] bool clocks_differ() const;
  [[nodiscard]] bool pair_up(Image arrived, ImageKind kind, ReadFrame& frame);
  void fill(Image reflectivity, Image depth, ReadFrame& frame) const;
  [[nodiscard]] std::string key_position(const char* key) const {
    return source_.position + "." + key;
  }

  SourceSettings source_;
  Camera camera_;
  ReadTolerance tolerance_;
  std::vector<std::string> files_;
  std::size_t files_opened_ = 0;
  std::unique_ptr<McapReader> file_;
  std::map<std::string, ImageTopic> images_;        // by topic
  std::map<std::string, Bytes> infos_;              // the first CameraInfo of each topic
  std::map<std::string, std::string> pose_frames_;  // frame of each PoseStamped topic
  TransformTree transforms_;
  std::string world_, camera_frame_;  // empty: no head pose
  StampPairs<Image> pairs_;
  std::uint64_t unpaired_ = 0, unreadable_ = 0;
  std::string first_unreadable_, missing_;
};

}  // namespace glint
