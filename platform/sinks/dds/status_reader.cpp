#include "platform/sinks/dds/status_reader.hpp"

#include <array>

#include "kernels/wire/bits.hpp"
#include "platform/sinks/dds/topic_names.hpp"

namespace glint {
namespace {

constexpr Quality k_everything{Reliability::reliable, Durability::volatile_data, k_keep_all};
constexpr std::uint32_t k_batch = 64;

dds_subscription_matched_status_t matches_of(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return status;
}

// Takes all available messages of a reader, in batches, without copies.
template <class Message, class Use>
void take_all(dds_entity_t reader, Use use) {
  for (;;) {
    std::array<void*, k_batch> samples{};
    std::array<dds_sample_info_t, k_batch> infos;
    const dds_return_t taken =
        dds_take(reader, samples.data(), infos.data(), samples.size(), k_batch);
    if (taken <= 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(taken); ++i) {
      if (infos[i].valid_data) use(*static_cast<const Message*>(samples[i]));
    }
    dds_return_loan(reader, samples.data(), taken);
  }
}

}  // namespace

StatusReader::StatusReader(const DdsSettings& settings) : participant_(settings) {
  waitset_ = participant_.waitset();
  for (const std::string& name : settings.tool_names) {
    const ToolTopics topics = topics_of(settings.topic_prefix, name, settings.name);
    ToolReader tool;
    // Created first: a sink that has discovered the status reader has then discovered this one too.
    tool.pose = participant_.reader(pose_stamped_type(), topics.pose, k_everything);
    tool.status = participant_.reader(status_type(), topics.status, k_everything);
    // A status that stays unread makes each wait return at once.
    dds_set_status_mask(tool.pose, DDS_DATA_AVAILABLE_STATUS);
    dds_set_status_mask(tool.status, DDS_DATA_AVAILABLE_STATUS | DDS_SUBSCRIPTION_MATCHED_STATUS);
    for (const dds_entity_t reader : {tool.pose, tool.status})
      dds_waitset_attach(waitset_, reader, 0);
    tools_.push_back(tool);
  }
  result_.streams = static_cast<std::uint32_t>(tools_.size());
}

void StatusReader::read(Duration limit) {
  dds_waitset_wait(waitset_, nullptr, 0, limit.nanoseconds);
  for (ToolReader& tool : tools_) {
    take_statuses(tool);
    take_poses(tool);
  }
}

void StatusReader::take_statuses(ToolReader& tool) {
  take_all<StatusMessage>(
      tool.status, [&](const StatusMessage& status) { count(tool, status, Time{dds_time()}); });
}

void StatusReader::take_poses(const ToolReader& tool) {
  take_all<PoseStampedMessage>(tool.pose,
                               [&](const PoseStampedMessage&) { ++result_.poses_received; });
}

void StatusReader::count(ToolReader& tool, const StatusMessage& status, Time taken) {
  const StreamMark mark{time_of(status.header.stamp), time_of(status.stream_start),
                        Duration{status.tick_period_ns}, status.ticks_not_sent};
  if (status.ends_stream) {
    tool.counter.end(mark);
    return;
  }
  tool.counter.add(mark);
  const auto state = static_cast<TrackState>(status.state);
  if (state == TrackState::measured || state == TrackState::predicted) ++result_.poses_expected;
  if (!any_received_) result_.first_tick = result_.last_tick = status.tick_number;
  any_received_ = true;
  result_.last_tick = extended_count(status.tick_number, result_.last_tick);
  latency_.add(taken - mark.stamp);
}

// Reads the status of each tool, also where the first decides.
StatusReader::Sinks StatusReader::sinks() const {
  Sinks sinks;
  for (const ToolReader& tool : tools_) {
    const dds_subscription_matched_status_t matches = matches_of(tool.status);
    sinks.found = sinks.found || matches.total_count > 0;
    sinks.present = sinks.present || matches.current_count > 0;
  }
  return sinks;
}

ReaderResult StatusReader::result() const {
  ReaderResult result = result_;
  for (const ToolReader& tool : tools_) {
    result.received += tool.counter.received();
    result.missed += tool.counter.missed();
    result.streams_ended += tool.counter.ended() ? 1 : 0;
  }
  result.latency_p50_us = latency_.quantile_us(0.5);
  result.latency_p99_us = latency_.quantile_us(0.99);
  result.latency_max_us = latency_.max_us();
  return result;
}

}  // namespace glint
