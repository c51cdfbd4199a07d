#include "platform/sinks/dds/pose_publisher.hpp"

#include <algorithm>
#include <climits>
#include <set>

#include "kernels/limits.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/dds/diagnostics.hpp"
#include "platform/sinks/dds/tick_gap.hpp"
#include "platform/sinks/dds/topic_types.hpp"

namespace glint {
namespace {

// Enough for retransmission of what a full socket lost: 400 ms at 250 Hz.
constexpr Quality k_status_quality{Reliability::reliable, Durability::volatile_data, 100};
// An older pose has no use: keep one, and never wait.
constexpr Quality k_pose_quality{Reliability::reliable, Durability::volatile_data, 1};
// Same QoS as tf2's broadcasters and diagnostic_updater.
constexpr Quality k_tf_quality{Reliability::reliable, Durability::volatile_data, 100};
// As tf2's static broadcaster and robot_state_publisher: late readers receive the newest message.
constexpr Quality k_latched_quality{Reliability::reliable, Durability::transient_local, 1};
constexpr Quality k_diagnostics_quality{Reliability::reliable, Durability::volatile_data, 1};

// A restart and the search for the readers, at the end of a run.
constexpr Duration k_ready_limit = milliseconds(10'000);

void check(const DdsSettings& settings) {
  const std::size_t count = settings.tool_names.size();
  if (count < 1 || count > static_cast<std::size_t>(k_tools_max)) {
    throw InputError("dds: found " + std::to_string(count) + " tools; expected 1 to " +
                     std::to_string(k_tools_max));
  }
  if (settings.tick_period.nanoseconds < 1 || settings.tick_period.nanoseconds > 1'000'000'000) {
    throw InputError("dds: found a tick period of " +
                     std::to_string(settings.tick_period.nanoseconds) +
                     " ns; expected 1 ns to 1 s");
  }
  if (!settings.name.empty() && settings.name != ros_name(settings.name)) {
    throw InputError("dds.name: \"" + settings.name +
                     "\"; expected letters, digits and '_', no digit first");
  }
  std::set<std::string> names;
  for (const std::string& name : settings.tool_names) {
    if (!names.insert(ros_name(name)).second) {
      throw InputError("dds: two tools have the topic name '" + ros_name(name) +
                       "'; expected names that differ in letters, digits or '_'");
    }
  }
}

}  // namespace

PosePublisher::PosePublisher(const DdsSettings& settings)
    : settings_((check(settings), settings)), process_(DdsProcess::of(settings)) {
  for (const std::string& name : settings_.tool_names) {
    ToolStream stream;
    stream.name = name;
    stream.topics = topics_of(settings_.topic_prefix, name, settings_.name);
    stream.status = process_->writer(status_type(), stream.topics.status, k_status_quality);
    stream.pose = process_->writer(pose_stamped_type(), stream.topics.pose, k_pose_quality);
    stream.pose_covariance =
        process_->writer(pose_covariance_type(), stream.topics.pose_covariance, k_pose_quality);
    stream.pose_systematic =
        process_->writer(pose_covariance_type(), stream.topics.pose_systematic, k_pose_quality);
    streams_.push_back(std::move(stream));
  }
  const auto add = [this](const TopicType& type, const char* topic, const Quality& quality) {
    return process_->writer(type, topic_in(settings_.name, topic), quality);
  };
  tf_ = add(tf_type(), k_tf_topic, k_tf_quality);
  tf_static_ = add(tf_type(), k_tf_static_topic, k_latched_quality);
  diagnostics_ = add(diagnostics_type(), k_diagnostics_topic, k_diagnostics_quality);
  write_static_transforms();
  if (settings_.robot_description.empty()) return;
  description_ = add(text_type(), k_robot_description_topic, k_latched_quality);
  const TextMessage description{settings_.robot_description.data()};
  write_unreliable(*description_, &description);
}

PosePublisher::~PosePublisher() {
  for (const int writer : writers()) process_->remove(writer);
}

int PosePublisher::readers() const {
  int readers_min = INT_MAX;
  for (const ToolStream& stream : streams_) {
    readers_min = std::min(readers_min, process_->matched(stream.status));
  }
  return readers_min;
}

ProcessCounts PosePublisher::process_counts() const {
  ProcessCounts counts;
  for (const ToolStream& stream : streams_) {
    counts.statuses += process_->published(stream.status);
    counts.poses += process_->published(stream.pose);
    counts.statuses_lost += process_->lost(stream.status);
  }
  for (const int writer : writers()) counts.others_lost += process_->lost(writer);
  counts.others_lost -= counts.statuses_lost;
  return counts;
}

std::vector<int> PosePublisher::writers() const {
  std::vector<int> all{tf_, tf_static_, diagnostics_};
  if (description_) all.push_back(*description_);
  for (const ToolStream& stream : streams_) {
    all.insert(all.end(),
               {stream.status, stream.pose, stream.pose_covariance, stream.pose_systematic});
  }
  return all;
}

bool PosePublisher::write(const PoseSample& sample) {
  if (sample.tool >= streams_.size()) return false;
  ToolStream& stream = streams_[sample.tool];
  if (!stream.started) {
    stream.started = true;
    stream.start = sample.tick;
    stream.last_written = sample.tick - settings_.tick_period;
  }
  stream.newest = sample.tick;
  stream.sample = sample;
  StatusMessage message{};
  message.header.frame_id = const_cast<char*>(frame_name(sample.frame));
  if (sample.frame_sequence != 0 || sample.has_pose()) {
    message.measurement = time_message(unix_time(sample.measurement));
  }
  message.tick_number = static_cast<std::uint32_t>(sample.tick_number);
  message.frame_sequence = static_cast<std::uint32_t>(sample.frame_sequence);
  message.state = static_cast<std::uint8_t>(sample.state);
  message.reason = static_cast<std::uint8_t>(sample.reason);
  message.registration = static_cast<std::uint8_t>(sample.registration);
  message.marker_mask = sample.marker_mask;
  message.buttons = sample.buttons;
  if (!write_status(stream, sample.tick, message)) return false;
  if (sample.has_pose()) write_pose(stream, sample);
  return true;
}

bool PosePublisher::write_status(ToolStream& stream, Time tick, StatusMessage message) {
  const std::int64_t skipped = ticks_between(stream.last_written, tick, settings_.tick_period) - 1;
  if (skipped < 0) return false;
  const std::uint64_t not_sent = stream.ticks_not_sent + static_cast<std::uint64_t>(skipped);
  message.header.stamp = time_message(unix_time(tick));
  message.stream_start = time_message(unix_time(stream.start));
  message.ticks_not_sent = not_sent;
  message.tick_period_ns = static_cast<std::uint32_t>(settings_.tick_period.nanoseconds);
  if (!process_->write(stream.status, &message)) return false;
  stream.ticks_not_sent = not_sent;
  stream.last_written = tick;
  return true;
}

void PosePublisher::write_pose(const ToolStream& stream, const PoseSample& sample) {
  const HeaderMessage header =
      header_message(unix_time(sample.tick + settings_.actuation_delay), frame_name(sample.frame));
  const PoseStampedMessage pose{header, pose_message(sample.pose)};
  const PoseCovarianceMessage total =
      pose_covariance_message(header, sample.pose, sample.covariance);
  const PoseCovarianceMessage systematic =
      pose_covariance_message(header, sample.pose, sample.systematic);
  TransformMessage transform =
      transform_message(header, stream.topics.tip_frame.c_str(), sample.pose);
  TfMessage tf{};
  tf.transforms._length = tf.transforms._maximum = 1;
  tf.transforms._buffer = &transform;
  write_unreliable(stream.pose, &pose);
  write_unreliable(stream.pose_covariance, &total);
  write_unreliable(stream.pose_systematic, &systematic);
  write_unreliable(tf_, &tf);
}

void PosePublisher::write_unreliable(int writer, const void* message) {
  if (!process_->write(writer, message)) ++others_failed_;
}

void PosePublisher::write_frame(const FrameTransforms& frame) {
  if (!frame.head.valid) return;
  const FrameNames& names = settings_.frames;
  const HeaderMessage header = header_message(unix_time(frame.head.time), names.world.c_str());
  TransformMessage transforms[] = {
      transform_message(header, names.camera.c_str(), frame.head.T_world_camera),
      transform_message(header, names.robot.c_str(), frame.T_world_robot)};
  TfMessage tf{};
  tf.transforms._length = tf.transforms._maximum = frame.robot_valid ? 2 : 1;
  tf.transforms._buffer = transforms;
  write_unreliable(tf_, &tf);
}

void PosePublisher::write_robot(const Pose& T_world_robot) {
  const FrameNames& frames = settings_.frames;
  std::erase_if(settings_.static_transforms,
                [&](const StaticTransform& one) { return one.child == frames.robot; });
  settings_.static_transforms.push_back({frames.world, frames.robot, T_world_robot});
  write_static_transforms();
}

void PosePublisher::write_static_transforms() {
  const Time now{dds_time()};
  std::vector<TransformMessage> transforms;
  for (const StaticTransform& one : settings_.static_transforms) {
    transforms.push_back(transform_message(header_message(now, one.parent.c_str()),
                                           one.child.c_str(), one.T_parent_child));
  }
  TfMessage tf{};
  tf.transforms._length = tf.transforms._maximum = static_cast<std::uint32_t>(transforms.size());
  tf.transforms._buffer = transforms.data();
  write_unreliable(tf_static_, &tf);
}

void PosePublisher::write_diagnostics(const SinkCounts& counts) {
  Diagnostics text;
  for (const ToolStream& stream : streams_) {
    if (stream.started) text.add(stream.name, stream.sample, counts);
  }
  if (settings_.overruns != nullptr) text.add_timing(*settings_.overruns, settings_.timing_faults);
  if (settings_.losses != nullptr) text.add_losses(*settings_.losses);
  if (const std::uint64_t restarts = process_->restarts(); restarts > 0) {
    text.add_process(restarts, process_->last_end());
  }
  if (settings_.access != nullptr) text.add_inputs(settings_.access->refusals());
  if (settings_.source != nullptr) {
    text.add_source(*settings_.source, faults_published_);
    faults_published_ = settings_.source->total();
  }
  if (settings_.robot != nullptr) text.add_robot(*settings_.robot);
  if (settings_.calibration != nullptr) text.add_calibration(settings_.calibration->all());
  const DiagnosticsMessage message = text.message(Time{dds_time()});
  write_unreliable(diagnostics_, &message);
}

void PosePublisher::end_streams(Duration limit) {
  // A restarted process publishes the marks when it has found the readers again.
  (void)process_->wait_until_ready(writers(), k_ready_limit);
  for (ToolStream& stream : streams_) {
    if (!stream.started) continue;
    StatusMessage message{};
    message.header.frame_id = const_cast<char*>(frame_name(stream.sample.frame));
    message.ends_stream = true;
    message.tick_number = static_cast<std::uint32_t>(stream.sample.tick_number + 1);
    write_status(stream, stream.newest + settings_.tick_period, message);
  }
  flush(limit);
}

const char* PosePublisher::frame_name(ReferenceFrame frame) const {
  switch (frame) {
    case ReferenceFrame::camera:
      return settings_.frames.camera.c_str();
    case ReferenceFrame::world:
      return settings_.frames.world.c_str();
    case ReferenceFrame::robot:
      return settings_.frames.robot.c_str();
  }
  return "";
}

}  // namespace glint
