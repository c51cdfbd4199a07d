#include "platform/sinks/record/mcap_writer.hpp"

#include <algorithm>

#include "platform/sinks/record/crc32.hpp"

namespace glint {
namespace {

// Statistics, summary offsets, footer and magic, without the message counts per channel.
constexpr std::uint64_t k_ending_fixed_bytes = 512;

template <class Record>
std::uint64_t size_of(const Record& record) {
  Bytes bytes;
  append_record(bytes, record);
  return bytes.size();
}

}  // namespace

McapWriter::McapWriter(const std::string& path, std::string_view profile, std::string_view library,
                       McapSettings settings)
    : settings_(settings), file_(path) {
  file_.sync_every(settings.sync_period);
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_header(bytes, profile, library);
  append_reserved({bytes});
}

// Upper bound of the bytes that close() appends.
std::uint64_t McapWriter::ending_bytes() const {
  return k_ending_fixed_bytes + settings_.closing_bytes + index_bytes_ + 10 * channels_.size();
}

bool McapWriter::append_reserved(std::initializer_list<std::span<const std::uint8_t>> parts) {
  std::uint64_t bytes = ending_bytes();
  for (const auto part : parts) bytes += part.size();
  failed_ = failed_ || !file_.reserve(bytes) || !file_.append(parts);
  return !failed_;
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      const std::string& schema_text, const McapTexts& metadata) {
  auto schema = std::find_if(schemas_.begin(), schemas_.end(),
                             [&](const McapSchema& s) { return s.name == schema_name; });
  if (schema == schemas_.end()) {
    const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
    schemas_.push_back({id, schema_name, "ros2msg", schema_text});
    schema = schemas_.end() - 1;
    index_bytes_ += size_of(*schema);
  }
  const auto id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back({id, schema->id, topic, "cdr", metadata});
  index_bytes_ += size_of(channels_.back());
  described_.push_back(false);
  return id;
}

void McapWriter::write(const McapMessageHeading& heading, std::span<const std::uint8_t> payload) {
  if (failed_) return;
  if (!described_[heading.channel_id]) {
    described_[heading.channel_id] = true;
    const McapChannel& channel = channels_[heading.channel_id];
    append_record(chunk_.records, schemas_[channel.schema_id - 1U]);
    append_record(chunk_.records, channel);
  }
  if (chunk_.messages++ == 0) chunk_.start = chunk_.end = heading.log_time;
  chunk_.start = std::min(chunk_.start, heading.log_time);
  chunk_.end = std::max(chunk_.end, heading.log_time);
  chunk_.times[heading.channel_id].emplace_back(heading.log_time, chunk_.records.size());
  append_record(chunk_.records, heading, payload);
  if (chunk_.records.size() >= settings_.chunk_bytes ||
      chunk_.end - chunk_.start >= settings_.chunk_span_ns)
    flush_chunk();
}

void McapWriter::flush_chunk() {
  if (failed_ || chunk_.messages == 0) return;
  McapChunkIndex index;
  index.start = chunk_.start;
  index.end = chunk_.end;
  index.offset = file_.size();
  index.record_bytes = chunk_.records.size();
  Bytes heading;
  append_chunk_heading(heading, {chunk_.start, chunk_.end, chunk_.records.size(),
                                 crc32(0, chunk_.records), "", chunk_.records.size()});
  index.length = heading.size() + chunk_.records.size();
  Bytes times;
  for (auto& [channel, entries] : chunk_.times) {
    index.index_offsets[channel] = index.offset + index.length + times.size();
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    append_message_index(times, channel, entries);
  }
  index.index_length = times.size();
  index_bytes_ += size_of(index);
  if (append_reserved({heading, chunk_.records, times})) {
    const bool first = statistics_.messages == 0;
    statistics_.start = first ? index.start : std::min(statistics_.start, index.start);
    statistics_.end = first ? index.end : std::max(statistics_.end, index.end);
    statistics_.messages += chunk_.messages;
    for (const auto& [channel, entries] : chunk_.times)
      statistics_.channel_messages[channel] += entries.size();
    chunk_indexes_.push_back(std::move(index));
  }
  chunk_.records.clear();
  chunk_.times.clear();
  chunk_.messages = 0;
}

void McapWriter::attach(const std::string& name, const std::string& media_type,
                        std::uint64_t time_ns, std::span<const std::uint8_t> data) {
  flush_chunk();
  if (failed_) return;
  McapAttachmentIndex index{file_.size(), 0, time_ns, time_ns, data.size(), name, media_type};
  Bytes heading;
  append_attachment_heading(heading, index);
  index.length = heading.size() + data.size() + sizeof(std::uint32_t);
  heading.clear();
  append_attachment_heading(heading, index);
  const auto checked = std::span<const std::uint8_t>(heading).subspan(k_mcap_heading_bytes);
  Bytes crc;
  append(crc, crc32(crc32(0, checked), data));
  index_bytes_ += size_of(index);
  if (append_reserved({heading, data, crc})) attachment_indexes_.push_back(std::move(index));
}

void McapWriter::add_metadata(const std::string& name, const McapTexts& texts) {
  flush_chunk();
  if (failed_) return;
  Bytes record;
  append_metadata(record, name, texts);
  const McapMetadataIndex index{file_.size(), record.size(), name};
  index_bytes_ += size_of(index);
  if (append_reserved({record})) metadata_indexes_.push_back(index);
}

McapWriter::Summary McapWriter::make_summary() const {
  Summary summary;
  const std::uint64_t start = file_.size();
  const auto group = [&](McapKind kind, const auto& records) {
    const std::size_t from = summary.records.size();
    for (const auto& record : records) append_record(summary.records, record);
    if (summary.records.size() == from) return;
    append_summary_offset(summary.offsets, kind, start + from, summary.records.size() - from);
  };
  McapStatistics statistics = statistics_;
  statistics.schemas = static_cast<std::uint16_t>(schemas_.size());
  statistics.channels = static_cast<std::uint32_t>(channels_.size());
  statistics.attachments = static_cast<std::uint32_t>(attachment_indexes_.size());
  statistics.metadata = static_cast<std::uint32_t>(metadata_indexes_.size());
  statistics.chunks = static_cast<std::uint32_t>(chunk_indexes_.size());
  group(McapKind::schema, schemas_);
  group(McapKind::channel, channels_);
  group(McapKind::statistics, std::span(&statistics, 1));
  group(McapKind::metadata_index, metadata_indexes_);
  group(McapKind::attachment_index, attachment_indexes_);
  group(McapKind::chunk_index, chunk_indexes_);
  return summary;
}

bool McapWriter::close(const std::string& metadata_name, const McapTexts& metadata) {
  flush_chunk();
  // From here on uses the space reserved before the last chunk.
  Bytes ending;
  append_metadata(ending, metadata_name, metadata);
  metadata_indexes_.push_back({file_.size(), ending.size(), metadata_name});
  append(ending, static_cast<std::uint8_t>(McapKind::data_end));
  append(ending, std::uint64_t{4});
  const std::uint32_t data_crc =
      crc32(file_.crc(), std::span(ending).first(ending.size() - k_mcap_heading_bytes));
  append(ending, data_crc);
  if (!file_.append({ending})) return false;

  const std::uint64_t start = file_.size();
  Summary summary = make_summary();
  const std::uint64_t offsets_start = start + summary.records.size();
  append(summary.records, summary.offsets);
  append_footer_heading(summary.records, start, offsets_start);
  append(summary.records, crc32(0, summary.records));
  append(summary.records, k_mcap_magic);
  return file_.append({summary.records}) && file_.finish();
}

}  // namespace glint
