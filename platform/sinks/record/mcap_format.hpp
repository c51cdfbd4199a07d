// MCAP file format, version 0: the records that Glint writes and reads, and their serialisation.
// All numbers are little endian.
// Source: the MCAP specification, foxglove/mcap 95d0673.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "platform/sinks/record/bytes.hpp"

namespace glint {

inline constexpr std::array<std::uint8_t, 8> k_mcap_magic{0x89, 'M', 'C',  'A',
                                                          'P',  '0', '\r', '\n'};
inline constexpr std::uint64_t k_mcap_heading_bytes = 9;  // kind, then length of the content
// Longer than any chunk or attachment of a real recording; bounds the memory requested by a flipped
// bit.
inline constexpr std::uint64_t k_mcap_record_bytes_max = std::uint64_t{256} << 20;
inline constexpr std::uint64_t k_mcap_footer_bytes = k_mcap_heading_bytes + 20;

enum class McapKind : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  attachment = 9,
  attachment_index = 10,
  statistics = 11,
  metadata = 12,
  metadata_index = 13,
  summary_offset = 14,
  data_end = 15,
};

using McapTexts = std::map<std::string, std::string>;

struct McapSchema {
  std::uint16_t id = 0;  // from 1
  std::string name, encoding, text;
};

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic, encoding;
  McapTexts metadata;
};

struct McapMessageHeading {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  // ns since 1970
};
inline constexpr std::uint64_t k_mcap_message_heading_bytes = 22;

struct McapChunkHeading {
  std::uint64_t start = 0, end = 0;  // log times
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t crc = 0;
  std::string compression;
  std::uint64_t record_bytes = 0;
};

struct McapChunkIndex {
  std::uint64_t start = 0, end = 0;
  std::uint64_t offset = 0, length = 0;                  // of the chunk record
  std::map<std::uint16_t, std::uint64_t> index_offsets;  // of its message indexes, by channel
  std::uint64_t index_length = 0;
  std::uint64_t record_bytes = 0;
};

struct McapAttachmentIndex {
  std::uint64_t offset = 0, length = 0;
  std::uint64_t log_time = 0, create_time = 0;
  std::uint64_t data_bytes = 0;
  std::string name, media_type;
};

struct McapMetadataIndex {
  std::uint64_t offset = 0, length = 0;
  std::string name;
};

struct McapStatistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  std::uint64_t start = 0, end = 0;
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

// Each function appends one complete record.
void append_header(Bytes& to, std::string_view profile, std::string_view library);
void append_record(Bytes& to, const McapSchema& schema);
void append_record(Bytes& to, const McapChannel& channel);
void append_record(Bytes& to, const McapMessageHeading& heading,
                   std::span<const std::uint8_t> payload);
void append_record(Bytes& to, const McapChunkIndex& index);
void append_record(Bytes& to, const McapAttachmentIndex& index);
void append_record(Bytes& to, const McapMetadataIndex& index);
void append_record(Bytes& to, const McapStatistics& statistics);
void append_metadata(Bytes& to, std::string_view name, const McapTexts& texts);
void append_summary_offset(Bytes& to, McapKind kind, std::uint64_t start, std::uint64_t length);

// For one channel in one chunk: (log time, offset in the chunk's records) of each message.
using McapMessageTimes = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
void append_message_index(Bytes& to, std::uint16_t channel_id, const McapMessageTimes& times);

// The part of a chunk, an attachment or a footer before its data or checksum.
void append_chunk_heading(Bytes& to, const McapChunkHeading& heading);
void append_attachment_heading(Bytes& to, const McapAttachmentIndex& attachment);
void append_footer_heading(Bytes& to, std::uint64_t summary_start, std::uint64_t offset_start);

// Contents of records; reader.failed() is true if they were too short.
[[nodiscard]] McapSchema read_schema(ByteReader& reader);
[[nodiscard]] McapChannel read_channel(ByteReader& reader);
[[nodiscard]] McapMessageHeading read_message_heading(ByteReader& reader);
[[nodiscard]] McapChunkHeading read_chunk_heading(ByteReader& reader);
[[nodiscard]] McapChunkIndex read_chunk_index(ByteReader& reader);  // its offset and length only
[[nodiscard]] McapAttachmentIndex read_attachment_index(ByteReader& reader);
[[nodiscard]] McapMetadataIndex read_metadata_index(ByteReader& reader);
[[nodiscard]] McapStatistics read_statistics(ByteReader& reader);
[[nodiscard]] McapTexts read_texts(ByteReader& reader);

}  // namespace glint
