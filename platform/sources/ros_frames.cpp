#include "platform/sources/ros_frames.hpp"

#include <algorithm>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/sources/ros_images.hpp"
#include "platform/sources/ros_transforms.hpp"

namespace glint {
namespace {

constexpr std::size_t k_live_images_waiting_max = 8;  // without a partner, per topic
constexpr std::size_t k_complete_max = 4;
constexpr std::size_t k_frame_name_max = 255;

std::string text_of(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

RosFrames::RosFrames(LiveSource& frames, const SourceSettings& source)
    : frames_(frames),
      pairs_({frames.camera().period.nanoseconds / 4}, k_live_images_waiting_max),
      pose_topic_(source.pose_topic),
      world_(source.world_frame) {
  streams_[0].topic = source.reflectivity_topic;
  streams_[1].topic = source.depth_topic;
  // All waiting images, and one per topic in progress.
  spare_.resize(2 * (k_live_images_waiting_max + k_complete_max + 2));
  for (Image& image : spare_) {
    image.frame.reserve(k_frame_name_max);
    image.values.resize(static_cast<std::size_t>(frames.camera().model.width) *
                        static_cast<std::size_t>(frames.camera().model.height));
  }
  complete_.reserve(k_complete_max + 1);
  world_.reserve(k_frame_name_max);
}

// Accepts one publisher per topic at a time. Its successor may have another clock.
bool RosFrames::is_publisher(Stream& stream, ImageKind kind, std::uint64_t publisher,
                             Time arrival) {
  if (stream.publisher != publisher) {
    if (stream.publisher && arrival - stream.newest_arrival < k_publisher_silent) {
      ++other_publisher_;
      return false;
    }
    stream.publisher = publisher;
    stream.newest_stamp = {INT64_MIN};
    while (std::optional<Image> old = pairs_.pop(kind)) {
      spare_.push_back(std::move(*old));
      ++unpaired_;
    }
    if (kind == ImageKind::reflectivity) {
      frames_.restart_clock();
      ++publishers_;
    }
  }
  stream.newest_arrival = arrival;
  return true;
}

void RosFrames::add_image(std::span<const std::uint8_t> message, ImageKind kind,
                          std::uint64_t publisher, Time arrival) {
  Stream& stream = streams_[static_cast<std::size_t>(kind)];
  if (!is_publisher(stream, kind, publisher, arrival)) return;
  Image image = std::move(spare_.back());
  spare_.pop_back();
  image.arrival = arrival;
  bool is_taken = false;
  try {
    read(message, stream, kind, image);
    is_taken = frames_.accept_rising(image.stamp, stream.newest_stamp);
  } catch (const InputError& error) {
    refuse(error.what());
  }
  if (is_taken) {
    pair_up(std::move(image), kind);
  } else {
    spare_.push_back(std::move(image));
  }
}

void RosFrames::read(std::span<const std::uint8_t> message, const Stream& stream, ImageKind kind,
                     Image& image) const {
  const Camera& camera = frames_.camera();
  const RosImageView view = ros_image_view(message, stream.topic);
  if (view.width != camera.model.width || view.height != camera.model.height) {
    throw InputError(stream.topic + ": " + text_of(view.width, view.height) + " pixels; expected " +
                     text_of(camera.model.width, camera.model.height) + " (" + camera.name + ")");
  }
  if (view.frame.size() > k_frame_name_max) {
    throw InputError(stream.topic + ": a frame's name of " + std::to_string(view.frame.size()) +
                     " characters; expected at most " + std::to_string(k_frame_name_max));
  }
  image.stamp = view.stamp;
  image.frame.assign(view.frame);
  read_values(view, camera.depth.unit_m, image.values);
  if (kind == ImageKind::depth || camera.reflectivity_bits > 8 || view.pixel_bytes == 1) return;
  const std::uint16_t most = *std::max_element(image.values.begin(), image.values.end());
  if (most <= 255) return;
  throw InputError(stream.topic + ": a value of " + std::to_string(most) +
                   "; expected at most 255 (" + camera.name + ")");
}

void RosFrames::pair_up(Image image, ImageKind kind) {
  const Time stamp = image.stamp;
  std::optional<Image> partner = pairs_.partner_of(kind, stamp);
  if (!partner) {
    if (auto old = pairs_.wait(kind, stamp, std::move(image))) {
      spare_.push_back(std::move(*old));
      ++unpaired_;
    }
    return;
  }
  if (kind == ImageKind::depth) std::swap(image, *partner);
  const Time arrival = std::max(image.arrival, partner->arrival);
  if (const auto mid_exposure = frames_.exposure_of(image.stamp, arrival)) {
    complete_.push_back({std::move(image), std::move(*partner), *mid_exposure, arrival});
    publish_ready(arrival);
  } else {
    spare_.push_back(std::move(image));
    spare_.push_back(std::move(*partner));
  }
}

std::string_view RosFrames::camera_of(const Pair& pair) const {
  return pose_topic_.empty() ? std::string_view(pair.reflectivity.frame) : pose_topic_;
}

// Returns true if the newest transform is before the frame, by at most k_transform_gap_max: a later
// one may follow.
bool RosFrames::may_get_pose(const Pair& pair) const {
  if (world_.empty()) return false;
  const std::optional<Time> until = transforms_.available_until(world_, camera_of(pair));
  return until && *until < pair.reflectivity.stamp &&
         pair.reflectivity.stamp - *until <= k_transform_gap_max;
}

void RosFrames::publish_ready(Time now) {
  while (!complete_.empty()) {
    Pair& oldest = complete_.front();
    if (may_get_pose(oldest)) {
      if (complete_.size() <= k_complete_max && now < due()) return;
      ++poses_late_;
    }
    deliver(oldest);
    spare_.push_back(std::move(oldest.reflectivity));
    spare_.push_back(std::move(oldest.depth));
    complete_.erase(complete_.begin());
  }
}

Time RosFrames::due() const {
  if (complete_.empty()) return {INT64_MAX};
  return complete_.front().arrival + frames_.camera().period * k_pose_wait_gaps;
}

void RosFrames::deliver(Pair& pair) {
  LiveSource::Slot* const slot = frames_.slot_for_next();
  if (slot == nullptr) return;
  slot->pixels.depth.swap(pair.depth.values);
  if (frames_.camera().reflectivity_bits > 8) {
    slot->pixels.reflectivity_16.swap(pair.reflectivity.values);
  } else {
    std::transform(pair.reflectivity.values.begin(), pair.reflectivity.values.end(),
                   slot->pixels.reflectivity_8.begin(),
                   [](std::uint16_t value) { return static_cast<std::uint8_t>(value); });
  }
  HeadPose head;
  if (!world_.empty()) {
    if (const auto pose = transforms_.at(world_, camera_of(pair), pair.reflectivity.stamp)) {
      head.valid = true;
      head.T_world_camera = *pose;
    }
  }
  frames_.publish(pair.mid_exposure, pair.arrival, head);
}

void RosFrames::add_transforms(std::span<const std::uint8_t> message, bool fixed) {
  add_ros_transforms(message, fixed, transforms_);
}

// The frame of the first pose is the world, unless the cell names it.
void RosFrames::add_pose(std::span<const std::uint8_t> message) {
  const std::string_view frame = add_ros_pose(message, pose_topic_, transforms_);
  if (frame.empty()) ++poses_incomplete_;
  if (world_.empty()) world_ = frame;
}

void RosFrames::refuse(const std::string& why) {
  frames_.note(SourceFault::packet_refused);
  if (refused_++ == 0) first_refusal_ = why;
}

void RosFrames::add_to(SourceReport& report) const {
  const std::uint64_t waiting =
      pairs_.waiting(ImageKind::reflectivity) + pairs_.waiting(ImageKind::depth);
  report.counts.insert(report.counts.end(),
                       {{"publishers", publishers_},
                        {"images_refused", refused_},
                        {"images_of_another_publisher", other_publisher_},
                        {"images_unpaired", unpaired_ + waiting},
                        {"head_poses_late", poses_late_},
                        {"transforms_refused", transforms_.refused() + poses_incomplete_}});
  if (refused_ > 0) {
    report.failures.push_back(std::to_string(refused_) +
                              " messages refused, the first: " + first_refusal_);
  }
  if (other_publisher_ > 0) {
    report.failures.push_back(std::to_string(other_publisher_) +
                              " images of another publisher on " + streams_[0].topic + " or " +
                              streams_[1].topic + "; expected one");
  }
}

}  // namespace glint
