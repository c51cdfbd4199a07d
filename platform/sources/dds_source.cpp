#include "platform/sources/dds_source.hpp"

#include <dds/ddsi/ddsi_serdata.h>

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
constexpr Duration k_lens_wait = milliseconds(10'000);
constexpr Duration k_lens_poll = milliseconds(10);

// Serialised bytes of one message, contiguous.
struct Packed {
  ddsi_serdata* data = nullptr;
  ddsrt_iovec_t bytes{};
  Packed() = default;
  ~Packed() {
    if (bytes.iov_base != nullptr) ddsi_serdata_to_ser_unref(data, &bytes);
    if (data != nullptr) ddsi_serdata_unref(data);
  }
  Packed(const Packed&) = delete;
  Packed& operator=(const Packed&) = delete;
  [[nodiscard]] std::span<const std::uint8_t> message() {
    (void)ddsi_serdata_to_ser_ref(data, 0, ddsi_serdata_size(data), &bytes);
    return {static_cast<const std::uint8_t*>(bytes.iov_base), bytes.iov_len};
  }
};

// Takes the next message; returns false if there is none.
bool take_serialised(dds_entity_t reader, Packed& packed, dds_sample_info_t& info) {
  return dds_takecdr(reader, &packed.data, 1, &info, DDS_ANY_STATE) == 1;
}

std::string checked_topic(const SourceSettings& source, const char* key, const std::string& topic) {
  std::string name = dds_topic(topic);
  if (!topic.empty() && !name.empty()) return name;
  throw InputError(source.position + "." + key + ": " +
                   (topic.empty() ? "missing" : "\"" + printable(topic) + "\"") +
                   "; expected a topic's name, e.g. /tof/image");
}

SourceLens lens_from(Participant& participant, const std::string& topic, LiveSettings live) {
  const dds_entity_t reader =
      participant.reader(camera_info_type(), dds_topic(topic),
                         {Reliability::best_effort, Durability::volatile_data, 1});
  const Time end = monotonic_now() + k_lens_wait;
  while (monotonic_now() < end && (live.stop == nullptr || !*live.stop)) {
    Packed packed;
    dds_sample_info_t info;
    if (take_serialised(reader, packed, info) && info.valid_data) {
      SourceLens lens{topic, {}, lens_text_of_camera_info(packed.message(), topic)};
      dds_delete(reader);
      return lens;
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
  DdsSettings settings;
  settings.domain = source.domain.value_or(cell.dds.domain);
  settings.interface = cell.dds.interface;
  auto participant = std::make_shared<Participant>(settings);
  if (!names_lens(cell)) {
    set_lens(cell, lens_from(*participant, source.camera_info_topic, live));
  }
  require_lens(cell);
  return std::unique_ptr<DdsSource>(new DdsSource(std::move(participant), cell, live));
}

DdsSource::DdsSource(std::shared_ptr<Participant> participant, const Cell& cell, LiveSettings live)
    : LiveSource(cell.camera, live),
      participant_(std::move(participant)),
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
  Input& input = inputs_.emplace_back(use, has_message_);
  input.topic = topic;
  input.reader = participant_->reader(type, dds_topic(topic), quality);
  dds_listener_t* const listener = dds_create_listener(&input);
  dds_lset_data_available(listener, on_message);
  dds_set_listener(input.reader, listener);
  dds_delete_listener(listener);
}

DdsSource::~DdsSource() {
  stop();
  for (const Input& input : inputs_) dds_delete(input.reader);
}

void DdsSource::stop() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

// Called on Cyclone's thread after each message. A full reader overwrites its oldest message, and
// Cyclone does not count it.
void DdsSource::on_message(dds_entity_t /*reader*/, void* argument) noexcept {
  Input& input = *static_cast<Input*>(argument);
  const bool is_image = input.use == Use::reflectivity || input.use == Use::depth;
  if (input.waiting >= (is_image ? k_image_queue_size : k_transform_queue_size)) {
    ++input.overwritten;
  } else {
    ++input.waiting;
  }
  input.has_message.post();
}

void DdsSource::run() noexcept {
  while (!stop_) {
    (void)has_message_.wait_until(std::min(monotonic_now() + k_live_poll, frames_.due()));
    bool any = true;
    for (int round = 0; any && round < k_take_rounds_max; ++round) {
      any = false;
      for (Input& input : inputs_) any = take(input) || any;  // transforms before their images
    }
    frames_.publish_ready(monotonic_now());
  }
}

bool DdsSource::take(Input& input) {
  Packed packed;
  dds_sample_info_t info;
  if (!take_serialised(input.reader, packed, info)) {
    input.waiting = 0;  // `waiting` also counted a publisher's end
    return false;
  }
  if (!info.valid_data) return true;
  if (input.waiting > 0) --input.waiting;
  if (ddsi_serdata_size(packed.data) > k_message_bytes_max) {
    frames_.refuse(input.topic + ": a message of " +
                   std::to_string(ddsi_serdata_size(packed.data)) + " bytes; expected at most " +
                   std::to_string(k_message_bytes_max));
    return true;
  }
  use(input, packed.message(), info.publication_handle);
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
  std::uint64_t lost = 0, overwritten = 0, incompatible = 0;
  for (const Input& input : inputs_) {
    dds_sample_lost_status_t samples{};
    dds_get_sample_lost_status(input.reader, &samples);
    lost += samples.total_count;
    overwritten += input.overwritten;
    dds_requested_incompatible_qos_status_t refused{};
    dds_get_requested_incompatible_qos_status(input.reader, &refused);
    if (refused.total_count == 0) continue;
    incompatible += refused.total_count;
    report.failures.push_back(
        input.topic +
        ": a best-effort publisher; expected a reliable one, or source.reliable = false");
  }
  report.counts.insert(report.counts.end(), {{"messages_lost", lost},
                                             {"messages_overwritten", overwritten},
                                             {"publishers_incompatible", incompatible}});
  add_to(report);
  if (lost > 0) report.failures.push_back(std::to_string(lost) + " messages lost in transport");
  if (overwritten > 0) {
    report.failures.push_back(std::to_string(overwritten) + " messages overwritten: read too late");
  }
  return report;
}

}  // namespace glint
