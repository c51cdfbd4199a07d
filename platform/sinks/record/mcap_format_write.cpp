#include "platform/sinks/record/mcap_format.hpp"

namespace glint {
namespace {

// Writes kind and length before the content that is appended during its lifetime.
class Record {
 public:
  Record(Bytes& to, McapKind kind) : to_(to) {
    append(to_, static_cast<std::uint8_t>(kind));
    content_ = to_.size() + sizeof(std::uint64_t);
    append(to_, std::uint64_t{0});
  }
  ~Record() { put_little_endian(std::span(to_).subspan(content_ - 8, 8), to_.size() - content_); }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

 private:
  Bytes& to_;
  std::size_t content_;
};

void append_texts(Bytes& to, const McapTexts& texts) {
  Bytes content;
  for (const auto& [name, text] : texts) {
    append(content, name);
    append(content, text);
  }
  append(to, static_cast<std::uint32_t>(content.size()));
  append(to, content);
}

void append_counts(Bytes& to, const std::map<std::uint16_t, std::uint64_t>& counts) {
  append(to, static_cast<std::uint32_t>(counts.size() * 10));
  for (const auto& [id, count] : counts) {
    append(to, id);
    append(to, count);
  }
}

}  // namespace

void append_header(Bytes& to, std::string_view profile, std::string_view library) {
  const Record record(to, McapKind::header);
  append(to, profile);
  append(to, library);
}

void append_record(Bytes& to, const McapSchema& schema) {
  const Record record(to, McapKind::schema);
  append(to, schema.id);
  append(to, schema.name);
  append(to, schema.encoding);
  append(to, schema.text);
}

void append_record(Bytes& to, const McapChannel& channel) {
  const Record record(to, McapKind::channel);
  append(to, channel.id);
  append(to, channel.schema_id);
  append(to, channel.topic);
  append(to, channel.encoding);
  append_texts(to, channel.metadata);
}

void append_record(Bytes& to, const McapMessageHeading& heading,
                   std::span<const std::uint8_t> payload) {
  const Record record(to, McapKind::message);
  append(to, heading.channel_id);
  append(to, heading.sequence);
  append(to, heading.log_time);
  append(to, heading.publish_time);
  append(to, payload);
}

void append_record(Bytes& to, const McapChunkIndex& index) {
  const Record record(to, McapKind::chunk_index);
  append(to, index.start);
  append(to, index.end);
  append(to, index.offset);
  append(to, index.length);
  append_counts(to, index.index_offsets);
  append(to, index.index_length);
  append(to, std::string_view());
  append(to, index.record_bytes);
  append(to, index.record_bytes);
}

void append_record(Bytes& to, const McapAttachmentIndex& index) {
  const Record record(to, McapKind::attachment_index);
  append(to, index.offset);
  append(to, index.length);
  append(to, index.log_time);
  append(to, index.create_time);
  append(to, index.data_bytes);
  append(to, index.name);
  append(to, index.media_type);
}

void append_record(Bytes& to, const McapMetadataIndex& index) {
  const Record record(to, McapKind::metadata_index);
  append(to, index.offset);
  append(to, index.length);
  append(to, index.name);
}

void append_record(Bytes& to, const McapStatistics& statistics) {
  const Record record(to, McapKind::statistics);
  append(to, statistics.messages);
  append(to, statistics.schemas);
  append(to, statistics.channels);
  append(to, statistics.attachments);
  append(to, statistics.metadata);
  append(to, statistics.chunks);
  append(to, statistics.start);
  append(to, statistics.end);
  append_counts(to, statistics.channel_messages);
}

void append_metadata(Bytes& to, std::string_view name, const McapTexts& texts) {
  const Record record(to, McapKind::metadata);
  append(to, name);
  append_texts(to, texts);
}

void append_summary_offset(Bytes& to, McapKind kind, std::uint64_t start, std::uint64_t length) {
  const Record record(to, McapKind::summary_offset);
  append(to, static_cast<std::uint8_t>(kind));
  append(to, start);
  append(to, length);
}

void append_message_index(Bytes& to, std::uint16_t channel_id, const McapMessageTimes& times) {
  const Record record(to, McapKind::message_index);
  append(to, channel_id);
  append(to, static_cast<std::uint32_t>(times.size() * 16));
  for (const auto& [log_time, offset] : times) {
    append(to, log_time);
    append(to, offset);
  }
}

void append_chunk_heading(Bytes& to, const McapChunkHeading& heading) {
  append(to, static_cast<std::uint8_t>(McapKind::chunk));
  const std::uint64_t fields = 8 + 8 + 8 + 4 + 4 + heading.compression.size() + 8;
  append(to, fields + heading.record_bytes);
  append(to, heading.start);
  append(to, heading.end);
  append(to, heading.uncompressed_bytes);
  append(to, heading.crc);
  append(to, heading.compression);
  append(to, heading.record_bytes);
}

void append_attachment_heading(Bytes& to, const McapAttachmentIndex& attachment) {
  append(to, static_cast<std::uint8_t>(McapKind::attachment));
  append(to, attachment.length - k_mcap_heading_bytes);
  append(to, attachment.log_time);
  append(to, attachment.create_time);
  append(to, attachment.name);
  append(to, attachment.media_type);
  append(to, attachment.data_bytes);
}

void append_footer_heading(Bytes& to, std::uint64_t summary_start, std::uint64_t offset_start) {
  append(to, static_cast<std::uint8_t>(McapKind::footer));
  append(to, k_mcap_footer_bytes - k_mcap_heading_bytes);
  append(to, summary_start);
  append(to, offset_start);
}

}  // namespace glint
