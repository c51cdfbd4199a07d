#include "platform/sources/rosbag_frames.hpp"

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sources/chunk_decoder.hpp"
#include "platform/sources/ros_transforms.hpp"

namespace glint {
namespace {

constexpr std::size_t k_waiting_max = 16;  // images without a partner, per topic
constexpr std::int64_t k_unix_from_ns = 1'000'000'000'000'000'000;  // 2001: smaller is no Unix time

constexpr const char* k_image_type = "sensor_msgs/msg/Image";
constexpr const char* k_camera_info_type = "sensor_msgs/msg/CameraInfo";
constexpr const char* k_tf_type = "tf2_msgs/msg/TFMessage";
constexpr const char* k_pose_type = "geometry_msgs/msg/PoseStamped";

std::vector<std::string> files_of(const std::string& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() == ".mcap") files.push_back(entry.path().string());
  }
  if (files.empty()) throw InputError(path + ": no .mcap file in it; expected a ROS 2 bag");
  // rosbag2 counts without leading zeros: bag_2 before bag_10.
  std::sort(files.begin(), files.end(), [](const std::string& a, const std::string& b) {
    return std::tuple(a.size(), a) < std::tuple(b.size(), b);
  });
  return files;
}

// Name of a pose topic's camera frame in the transform tree.
std::string camera_of(const std::string& topic) { return "the camera of " + topic; }

Time logged(const McapMessage& message) {
  return {static_cast<std::int64_t>(
      std::min<std::uint64_t>(message.heading.log_time, 4'000'000'000'000'000'000))};
}

template <class Map>
std::string names_of(const Map& map) {
  std::string names;
  for (const auto& [name, value] : map) names += (names.empty() ? "" : ", ") + printable(name);
  return names.empty() ? "none" : names;
}

}  // namespace

RosbagFrames::RosbagFrames(const SourceSettings& source, const Camera& camera,
                           ReadTolerance tolerance)
    : source_(source),
      camera_(camera),
      tolerance_(tolerance),
      files_(files_of(source.path)),
      pairs_({camera.period.nanoseconds / 4}, k_waiting_max) {
  scan();
  choose_topics();
  choose_poses();
  files_opened_ = 0;
  file_.reset();
  missing_.clear();
}

bool RosbagFrames::open_next_file() {
  if (file_) record_losses();
  file_.reset();
  if (files_opened_ == files_.size()) return false;
  file_ = std::make_unique<McapReader>(
      files_[files_opened_++], tolerance_.truncated ? McapEnding::optional : McapEnding::required,
      decode_chunk);
  return true;
}

void RosbagFrames::record_losses() {
  const McapLosses& losses = file_->losses();
  if (!losses.any() || !missing_.empty()) return;
  std::uint64_t messages = 0;
  for (const auto& [topic, count] : losses.messages) messages += count;
  missing_ = file_->file().path() + ": missing: " + (losses.at_least ? "at least " : "") +
             std::to_string(messages) + " messages, " + std::to_string(losses.bytes) + " bytes";
}

std::optional<McapMessage> RosbagFrames::next_message() {
  for (;;) {
    if (file_) {
      if (auto message = file_->next()) return message;
    }
    if (!open_next_file()) return std::nullopt;
  }
}

void RosbagFrames::scan() {
  while (const auto message = next_message()) {
    if (message->schema == nullptr || message->channel->encoding != "cdr") continue;
    scan(*message);
  }
}

void RosbagFrames::scan(const McapMessage& message) {
  const std::string &type = message.schema->name, &topic = message.channel->topic;
  if (type == k_image_type) {
    ImageTopic& images = images_[topic];
    const RosHeader header = ros_header_of(message.payload, topic);
    const Duration delay = logged(message) - header.stamp;
    if (images.count++ == 0) {
      images.first = header;
      images.min_delay = delay;
    }
    images.min_delay = std::min(images.min_delay, delay);
  } else if (type == k_camera_info_type) {
    infos_.try_emplace(topic, message.payload.begin(), message.payload.end());
  } else if (type == k_tf_type) {
    add_ros_transforms(message.payload, topic.ends_with("tf_static"), transforms_);
  } else if (type == k_pose_type && topic == source_.pose_topic) {
    pose_frames_.try_emplace(topic, ros_header_of(message.payload, topic).frame);
    add_ros_pose(message.payload, camera_of(topic), transforms_);
  }
}

// Default: the only topic with "depth" in its name, and the only other one.
void RosbagFrames::choose_topics() {
  std::string &bright = source_.reflectivity_topic, &depth = source_.depth_topic;
  const auto only = [&](auto&& wanted) {
    std::string found;
    for (const auto& [topic, images] : images_) {
      if (!wanted(topic)) continue;
      if (!found.empty()) return std::string();
      found = topic;
    }
    return found;
  };
  const auto is_depth = [](const std::string& t) { return t.find("depth") != std::string::npos; };
  if (depth.empty()) depth = only([&](const std::string& t) { return t != bright && is_depth(t); });
  if (bright.empty())
    bright = only([&](const std::string& t) { return t != depth && !is_depth(t); });
  const auto check = [&](const char* key, const std::string& topic) {
    if (!topic.empty() && images_.contains(topic)) return;
    throw InputError(
        key_position(key) + ": " + (topic.empty() ? "missing" : "no image on " + printable(topic)) +
        "; expected one of the image topics in " + source_.path + ": " + names_of(images_));
  };
  check("reflectivity_topic", bright);
  check("depth_topic", depth);
  std::string& info = source_.camera_info_topic;
  if (!info.empty() && !infos_.contains(info)) {
    throw InputError(key_position("camera_info_topic") + ": no CameraInfo on " + printable(info) +
                     "; expected one of: " + names_of(infos_));
  }
  for (const std::string& beside : {camera_info_topic_of(bright), camera_info_topic_of(depth)}) {
    if (info.empty() && infos_.contains(beside)) info = beside;
  }
  if (info.empty() && infos_.size() == 1) info = infos_.begin()->first;
}

void RosbagFrames::choose_poses() {
  const std::string& topic = source_.pose_topic;
  if (!topic.empty()) {
    if (!pose_frames_.contains(topic)) {
      throw InputError(key_position("pose_topic") + ": no PoseStamped on " + printable(topic) +
                       "; expected the camera's pose");
    }
    camera_frame_ = camera_of(topic);
  } else {
    const std::string& frame = images_.at(source_.reflectivity_topic).first.frame;
    if (transforms_.has(frame) && transforms_.root_of(frame) != frame) camera_frame_ = frame;
  }
  if (camera_frame_.empty()) {
    if (source_.world_frame.empty()) return;
    throw InputError(key_position("world_frame") + ": no transforms from the images' frame \"" +
                     images_.at(source_.reflectivity_topic).first.frame +
                     "\"; expected them on tf, or a pose_topic");
  }
  world_ = source_.world_frame.empty() ? transforms_.root_of(camera_frame_) : source_.world_frame;
  if (transforms_.root_of(world_) != transforms_.root_of(camera_frame_)) {
    throw InputError(key_position("world_frame") + ": \"" + world_ +
                     "\" has no chain of transforms to " + camera_frame_ +
                     "; expected a frame of its tree with root " +
                     transforms_.root_of(camera_frame_));
  }
}

std::optional<SourceLens> RosbagFrames::lens() const {
  const auto info = infos_.find(source_.camera_info_topic);
  if (info == infos_.end()) return std::nullopt;
  const std::string place = source_.path + ":" + info->first;
  return SourceLens{place, {}, lens_text_of_camera_info(info->second, place)};
}

bool RosbagFrames::next(ReadFrame& frame) {
  while (const auto message = next_message()) {
    const std::string& topic = message->channel->topic;
    const ImageKind kind =
        topic == source_.depth_topic ? ImageKind::depth : ImageKind::reflectivity;
    if (message->schema == nullptr || message->schema->name != k_image_type ||
        message->channel->encoding != "cdr" ||
        (kind == ImageKind::reflectivity && topic != source_.reflectivity_topic)) {
      continue;
    }
    try {
      Image image{ros_image_of(message->payload, camera_.depth.unit_m, source_.path + ":" + topic),
                  logged(*message)};
      if (pair_up(std::move(image), kind, frame)) return true;
    } catch (const InputError& error) {
      if (unreadable_++ == 0) first_unreadable_ = error.what();
    }
  }
  for (const ImageKind kind : {ImageKind::reflectivity, ImageKind::depth}) {
    while (pairs_.pop(kind)) ++unpaired_;
  }
  return false;
}

// Returns true if the image has a partner; otherwise it waits.
bool RosbagFrames::pair_up(Image arrived, ImageKind kind, ReadFrame& frame) {
  const Time stamp = arrived.image.header.stamp;
  std::optional<Image> partner = pairs_.partner_of(kind, stamp);
  if (!partner) {
    unpaired_ += pairs_.wait(kind, stamp, std::move(arrived)) ? 1 : 0;
    return false;
  }
  if (kind == ImageKind::depth) std::swap(arrived, *partner);
  fill(std::move(arrived), std::move(*partner), frame);
  return true;
}

Duration RosbagFrames::min_delay() const {
  return std::max(images_.at(source_.reflectivity_topic).min_delay,
                  images_.at(source_.depth_topic).min_delay);
}

// Returns true if stamps and log times are of different clocks: a delay is negative, or the
// smallest delay exceeds the declared one by more than a frame period, impossible for a working
// camera.
bool RosbagFrames::clocks_differ() const {
  const Duration least = min_delay();
  return least < Duration{} || least > declared_delay() + camera_.period;
}

void RosbagFrames::fill(Image reflectivity, Image depth, ReadFrame& frame) const {
  frame = ReadFrame{};
  frame.mid_exposure = reflectivity.image.header.stamp;
  frame.arrival = std::max(reflectivity.logged, depth.logged);
  if (clocks_differ()) frame.arrival = *frame.arrival - min_delay() + declared_delay();
  if (!world_.empty()) {
    if (const auto pose = transforms_.at(world_, camera_frame_, frame.mid_exposure)) {
      frame.head.valid = true;
      frame.head.T_world_camera = *pose;
    }
  }
  fill_pixels(std::move(reflectivity.image.plane), std::move(depth.image.plane), camera_,
              frame.pixels);
}

ReaderCounts RosbagFrames::counts() const {
  return {{"images_unpaired", unpaired_}, {"transforms_refused", transforms_.refused()}};
}

std::string RosbagFrames::missing() const { return missing_; }

std::string RosbagFrames::text() const {
  return "rosbag " + source_.path + ": " + printable(source_.reflectivity_topic) + " and " +
         printable(source_.depth_topic) +
         (world_.empty() ? ", no head pose" : ", head pose in " + printable(world_)) +
         (clocks_differ() ? ", log times and stamps of different clocks" : "");
}

std::optional<Duration> RosbagFrames::unix_offset() const {
  const std::int64_t first = images_.at(source_.reflectivity_topic).first.stamp.nanoseconds;
  if (first < k_unix_from_ns) return std::nullopt;
  return Duration{};
}

}  // namespace glint
