// Recovery of a damaged or truncated MCAP file: skips damaged records and counts their messages.
#include <algorithm>

#include "platform/input_error.hpp"
#include "platform/sinks/record/mcap_reader.hpp"

namespace glint {

std::optional<McapMessage> McapReader::next() {
  if (ending_ == McapEnding::required) return next_intact();
  while (!ended_) {
    try {
      if (auto found = next_intact()) return found;
      ended_ = true;
      skip_tail();
      count_by_statistics();
    } catch (const InputError&) {
      if (compressed_) throw;
      skip_record();
    }
  }
  return std::nullopt;
}

// Skips the record that is open or that could not be opened. The index gives the start of the next
// record; without an index its own length is used.
void McapReader::skip_record() {
  const bool opened = at_ > record_at_;
  const auto kind = opened ? static_cast<McapKind>(record_[0]) : McapKind{};
  const auto known = indexed_records_.find(record_at_);
  const auto next = indexed_records_.upper_bound(record_at_);
  const bool is_chunk = indexed_records_.empty() ? !opened || kind == McapKind::chunk
                                                 : known != indexed_records_.end() &&
                                                       known->second.kind == McapKind::chunk;
  chunk_.reset();
  if (kind == McapKind::data_end) {  // its checksum includes the skipped records
    at_ = data_end_;
    return;
  }
  if (is_chunk) {
    ++losses_.chunks;
    losses_.at_least = true;
  }
  if (is_chunk && opened) {
    ByteReader content(std::span<const std::uint8_t>(record_).subspan(k_mcap_heading_bytes));
    if (read_chunk_heading(content).compression.empty()) count_messages(content);
  }
  if (!indexed_records_.empty())
    at_ = next == indexed_records_.end() ? data_end_ : next->first;
  else if (!opened)
    at_ = data_end_;
  losses_.bytes += known != indexed_records_.end() ? known->second.length : at_ - record_at_;
}

// Counts what follows the last complete record of a truncated file.
void McapReader::skip_tail() {
  if (has_ending_ || has_data_end_) return;
  losses_.at_least = true;
  losses_.bytes += file_.size() - data_end_;
  file_.read(data_end_, std::min(file_.size() - data_end_, k_mcap_record_bytes_max), record_);
  ByteReader content(record_);
  if (static_cast<McapKind>(content.number<std::uint8_t>()) != McapKind::chunk) return;
  (void)content.number<std::uint64_t>();
  if (read_chunk_heading(content).compression.empty()) count_messages(content);
}

// Counts the messages that start in a chunk's records, up to the first invalid one.
void McapReader::count_messages(ByteReader records) {
  std::map<std::uint16_t, std::string> topics;
  for (const auto& [id, channel] : channels_) topics[id] = channel.topic;
  while (!records.failed() && !records.at_end()) {
    const auto kind = static_cast<McapKind>(records.number<std::uint8_t>());
    const auto bytes = records.number<std::uint64_t>();
    ByteReader content(records.take(std::min(bytes, records.left())));
    if (kind == McapKind::channel) {
      const McapChannel channel = read_channel(content);
      if (!content.failed()) topics[channel.id] = channel.topic;
    }
    if (kind != McapKind::message) continue;
    const McapMessageHeading heading = read_message_heading(content);
    const auto topic = topics.find(heading.channel_id);
    if (content.failed() || topic == topics.end()) return;
    ++losses_.messages[topic->second];
  }
}

// The statistics of a closed file give the exact number of missing messages.
void McapReader::count_by_statistics() {
  if (!statistics_) return;
  losses_.messages.clear();
  losses_.at_least = false;
  for (const auto& [id, count] : statistics_->channel_messages) {
    const auto channel = channels_.find(id);
    if (channel != channels_.end() && count > messages_read_[id])
      losses_.messages[channel->second.topic] += count - messages_read_[id];
  }
}

}  // namespace glint
