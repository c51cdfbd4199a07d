#include "platform/sources/dds_source.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/runtime/rt/clock.hpp"
#include "platform/sinks/dds/messages.hpp"
#include "platform/sinks/dds/network.hpp"
#include "platform/sinks/dds/topic_names.hpp"
#include "platform/sinks/dds/topic_types.hpp"
#include "platform/sources/ros_images.hpp"

namespace glint {
namespace {

constexpr int k_image_queue_size = 16;       // a third of a second of AHAT, 0.5 MB each
constexpr int k_transform_queue_size = 100;  // as tf2_ros
constexpr int k_take_rounds_max = 256;       // rounds over the topics per reading of the clock
constexpr std::size_t k_camera_info_bytes = std::size_t{16} << 10;
constexpr std::size_t k_transforms_bytes = std::size_t{1} << 20;
constexpr Duration k_lens_wait = milliseconds(10'000);
constexpr Duration k_lens_poll = milliseconds(10);

std::string checked_topic(const SourceSettings& source, const char* key, const std::string& topic) {
  std::string name = dds_topic(topic);
  if (!topic.empty() && !name.empty()) return name;
  throw InputError(source.position + "." + key + ": " +
                   (topic.empty() ? "missing" : "\"" + printable(topic) + "\"") +
                   "; expected a topic's name, e.g. /tof/image");
}

SourceLens lens_from(DdsProcess& process, const std::string& topic, LiveSettings live) {
  const int reader =
      process.reader(camera_info_type(), dds_topic(topic),
                     {Reliability::best_effort, Durability::volatile_data, 1}, k_camera_info_bytes);
  const Time end = monotonic_now() + k_lens_wait;
  while (monotonic_now() < end && (live.stop == nullptr || !*live.stop)) {
    ReceivedMessage message;
    if (process.take(reader, message) && message.kind == RecordKind::message) {
      process.remove(reader);
      return {topic, {}, lens_text_of_camera_info(message.bytes, topic)};
    }
    (void)sleep_until(monotonic_now() + k_lens_poll);
  }
  throw MissingDevice(topic + ": no CameraInfo within " +
                      std::to_string(k_lens_wait.nanoseconds / 1'000'000'000) +
                      " s; expected one, or a lens in the cell (camera.file, camera.ray_table)");
}

}  // namespace

std::unique_ptr<DdsSource> DdsSource::open(Cell& cell, LiveSettings live) {
  SourceSettings& source = cell.source;
  (void)checked_topic(source, "reflectivity_topic", source.reflectivity_topic);
  (void)checked_topic(source, "depth_topic", source.depth_topic);
  if (source.camera_info_topic.empty()) {
    source.camera_info_topic = camera_info_topic_of(source.reflectivity_topic);
  }
  (void)checked_topic(source, "camera_info_topic", source.camera_info_topic);
  if (!source.pose_topic.empty()) (void)checked_topic(source, "pose_topic", source.pose_topic);
  DdsSettings settings = network_of(cell.dds);
  settings.domain = source.domain.value_or(cell.dds.domain);
  auto process = DdsProcess::of(settings, DdsProcess::k_image_bytes);
  if (!names_lens(cell)) {
    set_lens(cell, lens_from(*process, source.camera_info_topic, live));
  }
  require_lens(cell);
  return std::unique_ptr<DdsSource>(new DdsSource(std::move(process), cell, live));
}

DdsSource::DdsSource(std::shared_ptr<DdsProcess> process, const Cell& cell, LiveSettings live)
    : LiveSource(cell.camera, live),
      process_(std::move(process)),
      source_(cell.source),
      domain_(cell.source.domain.value_or(cell.dds.domain)),
      frames_(*this, cell.source) {
  if (!source_.world_frame.empty()) {
    add(Use::fixed_transforms, "/tf_static", true);
    add(Use::moving_transforms, "/tf", source_.reliable);
  }
  if (!source_.pose_topic.empty()) add(Use::pose, source_.pose_topic, source_.reliable);
  add(Use::reflectivity, source_.reflectivity_topic, source_.reliable);
  add(Use::depth, source_.depth_topic, source_.reliable);
  thread_ = std::thread([this] { run(); });
}

// A best-effort reader also matches reliable publishers.
void DdsSource::add(Use use, const std::string& topic, bool reliable) {
  const bool is_image = use == Use::reflectivity || use == Use::depth;
  const TopicType type = is_image           ? image_type()
                         : use == Use::pose ? pose_stamped_type()
                                            : tf_type();
  Quality quality;
  quality.reliability = reliable ? Reliability::reliable : Reliability::best_effort;
  quality.depth = is_image ? k_image_queue_size : k_transform_queue_size;
  if (use == Use::fixed_transforms) quality.durability = Durability::transient_local;
  const std::size_t bytes_max = is_image ? k_message_bytes_max : k_transforms_bytes;
  inputs_.push_back({use, topic, process_->reader(type, dds_topic(topic), quality, bytes_max)});
}

DdsSource::~DdsSource() {
  stop();
  for (const Input& input : inputs_) process_->remove(input.reader);
}

void DdsSource::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void DdsSource::run() noexcept {
  std::uint64_t arrivals = 0;
  while (!stop_) {
    const Duration until_due = frames_.due() - monotonic_now();
    arrivals = process_->wait(arrivals, std::clamp(until_due, Duration{}, k_live_poll));
    bool any = true;
    for (int round = 0; any && round < k_take_rounds_max; ++round) {
      any = false;
      for (const Input& input : inputs_)
        any = take(input) || any;  // transforms before their images
    }
    frames_.publish_ready(monotonic_now());
  }
}

bool DdsSource::take(const Input& input) {
  ReceivedMessage message;
  if (!process_->take(input.reader, message)) return false;
  if (message.kind == RecordKind::message) use(input, message.bytes, message.sender);
  return true;
}

void DdsSource::use(const Input& input, std::span<const std::uint8_t> message,
                    std::uint64_t publisher) {
  switch (input.use) {
    case Use::reflectivity:
      return frames_.add_image(message, ImageKind::reflectivity, publisher, monotonic_now());
    case Use::depth:
      return frames_.add_image(message, ImageKind::depth, publisher, monotonic_now());
    case Use::pose:
      return frames_.add_pose(message);
    case Use::moving_transforms:
    case Use::fixed_transforms:
      return frames_.add_transforms(message, input.use == Use::fixed_transforms);
  }
}

SourceReport DdsSource::report() {
  stop();
  SourceReport report;
  report.text = "dds domain " + std::to_string(domain_) + ": " +
                printable(source_.reflectivity_topic) + " and " + printable(source_.depth_topic) +
                (frames_.publishers() == 0 ? ": no image received" : "");
  frames_.add_to(report);
  std::uint64_t lost = 0, overwritten = 0, too_large = 0, incompatible = 0;
  for (const Input& input : inputs_) {
    const ReaderLosses losses = process_->losses(input.reader);
    lost += losses.lost;
    overwritten += losses.overwritten;
    too_large += losses.refused;
    if (losses.incompatible == 0) continue;
    incompatible += losses.incompatible;
    report.failures.push_back(
        input.topic +
        ": a best-effort publisher; expected a reliable one, or source.reliable = false");
  }
  report.counts.insert(report.counts.end(), {{"messages_lost", lost},
                                             {"messages_overwritten", overwritten},
                                             {"messages_too_large", too_large},
                                             {"publishers_incompatible", incompatible},
                                             {"dds_restarts", process_->restarts()}});
  add_to(report);
  if (lost > 0) report.failures.push_back(std::to_string(lost) + " messages lost in transport");
  if (overwritten > 0) {
    report.failures.push_back(std::to_string(overwritten) + " messages overwritten: read too late");
  }
  if (too_large > 0) {
    report.failures.push_back(std::to_string(too_large) + " messages refused: too large");
  }
  if (process_->restarts() > 0) {
    report.failures.push_back("the DDS process " + process_->last_end() + ": restarted " +
                              std::to_string(process_->restarts()) + " times");
  }
  return report;
}

}  // namespace glint
