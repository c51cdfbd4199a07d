#include "platform/sinks/record/mcap_reader.hpp"

#include <algorithm>

#include "platform/sinks/record/crc32.hpp"

namespace glint {
namespace {

std::string kind_and_length(std::uint64_t kind, std::uint64_t bytes) {
  return "a record of kind " + std::to_string(kind) + " and " + std::to_string(bytes) + " bytes";
}

}  // namespace

void McapReader::refuse_content(std::uint64_t offset, const char* kind) const {
  file_.refuse(offset, std::string(kind) + " record too short for its fields",
               "the fields of the MCAP specification");
}

McapReader::Heading McapReader::heading_at(std::uint64_t offset, std::uint64_t end) const {
  if (end - offset < k_mcap_heading_bytes)
    file_.refuse(offset, std::to_string(end - offset) + " bytes", "a record");
  Bytes bytes;
  file_.read(offset, k_mcap_heading_bytes, bytes);
  ByteReader reader(bytes);
  const auto kind = reader.number<std::uint8_t>();
  const auto length = reader.number<std::uint64_t>();
  if (kind == 0 || length > end - offset - k_mcap_heading_bytes || length > k_mcap_record_bytes_max)
    file_.refuse(offset, kind_and_length(kind, length),
                 "a record within the " + std::to_string(end - offset - k_mcap_heading_bytes) +
                     " remaining bytes, and at most " + std::to_string(k_mcap_record_bytes_max));
  return {static_cast<McapKind>(kind), length};
}

void McapReader::read_metadata(const McapMetadataIndex& index) {
  Bytes bytes;
  file_.read(index.offset + k_mcap_heading_bytes, index.length - k_mcap_heading_bytes, bytes);
  ByteReader reader(bytes);
  const std::string name = reader.text();
  McapTexts texts = read_texts(reader);
  if (reader.failed()) refuse_content(index.offset, "metadata");
  metadata_[name] = std::move(texts);
}

void McapReader::add_schema(ByteReader& content, std::uint64_t offset) {
  McapSchema schema = read_schema(content);
  if (content.failed() || schema.id == 0) refuse_content(offset, "schema");
  schemas_.insert_or_assign(schema.id, std::move(schema));
}

void McapReader::add_channel(ByteReader& content, std::uint64_t offset) {
  McapChannel channel = read_channel(content);
  if (content.failed()) refuse_content(offset, "channel");
  channels_.insert_or_assign(channel.id, std::move(channel));
}

bool McapReader::open_record() {
  if (at_ >= data_end_) return false;
  record_at_ = at_;
  const Heading heading = heading_at(at_, data_end_);
  const std::uint64_t record_bytes = k_mcap_heading_bytes + heading.bytes;
  const auto known = indexed_records_.find(at_);
  if (known != indexed_records_.end() &&
      (known->second.kind != heading.kind || known->second.length != record_bytes))
    file_.refuse(at_, kind_and_length(static_cast<std::uint64_t>(heading.kind), heading.bytes),
                 "the record of the index; the file is damaged here");
  file_.read(at_, record_bytes, record_);
  at_ += record_bytes;
  if (heading.kind != McapKind::data_end) crc_ = crc32(crc_, record_);
  return true;
}

void McapReader::open_chunk(std::uint64_t offset) {
  ByteReader content(std::span<const std::uint8_t>(record_).subspan(k_mcap_heading_bytes));
  const McapChunkHeading heading = read_chunk_heading(content);
  if (content.failed()) refuse_content(offset, "chunk");
  auto records = content.take(heading.record_bytes);
  const bool plain = heading.compression.empty();
  if (content.failed() || (plain && heading.uncompressed_bytes != heading.record_bytes))
    refuse_content(offset, "chunk");
  if (!plain) {
    if (heading.uncompressed_bytes > k_mcap_record_bytes_max) refuse_content(offset, "chunk");
    const bool known = heading.compression == "zstd" || heading.compression == "lz4";
    decoded_.resize(heading.uncompressed_bytes);
    if (decoder_ == nullptr || !decoder_(heading.compression, records, decoded_)) {
      compressed_ = compressed_ || (known && decoder_ == nullptr);
      file_.refuse(offset, "a chunk compressed with '" + heading.compression.substr(0, 16) + "'",
                   decoder_ == nullptr ? "chunks without compression, as Glint writes them"
                   : known             ? "a complete one; the file is damaged here"
                                       : "zstd, lz4 or none");
    }
    records = decoded_;
  }
  const std::uint32_t crc = crc32(0, records);
  if (heading.crc != 0 && heading.crc != crc)
    file_.refuse(offset, "a chunk with checksum " + std::to_string(crc),
                 std::to_string(heading.crc) +
                     "; the file is damaged here; --allow-truncated reads the other chunks");
  chunk_.emplace(records);
}

std::optional<McapMessage> McapReader::message(ByteReader& content) {
  McapMessage found;
  found.heading = read_message_heading(content);
  if (content.failed()) refuse_content(record_at_, "message");
  const auto channel = channels_.find(found.heading.channel_id);
  if (channel == channels_.end())
    file_.refuse(record_at_, "a message of channel " + std::to_string(found.heading.channel_id),
                 "one of a previously described channel");
  found.channel = &channel->second;
  const auto schema = schemas_.find(found.channel->schema_id);
  found.schema = schema == schemas_.end() ? nullptr : &schema->second;
  found.file_offset = record_at_;
  ++messages_;
  ++messages_read_[found.heading.channel_id];
  return found;
}

std::optional<McapMessage> McapReader::next_in_chunk() {
  while (chunk_ && !chunk_->at_end()) {
    const auto kind = static_cast<McapKind>(chunk_->number<std::uint8_t>());
    const auto bytes = chunk_->take(chunk_->number<std::uint64_t>());
    if (chunk_->failed()) refuse_content(record_at_, "chunk");
    ByteReader content(bytes);
    if (kind == McapKind::schema) add_schema(content, record_at_);
    if (kind == McapKind::channel) add_channel(content, record_at_);
    if (kind != McapKind::message) continue;
    auto found = message(content);
    found->payload = bytes.subspan(k_mcap_message_heading_bytes);
    return found;
  }
  chunk_.reset();
  return std::nullopt;
}

void McapReader::check_end(std::uint64_t offset) {
  ByteReader content(std::span<const std::uint8_t>(record_).subspan(k_mcap_heading_bytes));
  const auto expected = content.number<std::uint32_t>();
  if (content.failed()) refuse_content(offset, "data end");
  if (expected != 0 && expected != crc_)
    file_.refuse(offset, "records with checksum " + std::to_string(crc_),
                 std::to_string(expected) + "; the file is damaged before this byte");
  if (statistics_ && statistics_->messages != messages_)
    file_.refuse(offset, std::to_string(messages_) + " messages",
                 std::to_string(statistics_->messages) + ", by its statistics");
  at_ = data_end_;
}

std::optional<McapMessage> McapReader::next_intact() {
  for (;;) {
    if (auto found = next_in_chunk()) return found;
    if (!open_record()) return std::nullopt;
    ByteReader content(std::span<const std::uint8_t>(record_).subspan(k_mcap_heading_bytes));
    switch (static_cast<McapKind>(record_[0])) {
      case McapKind::chunk:
        open_chunk(record_at_);
        break;
      case McapKind::schema:
        add_schema(content, record_at_);
        break;
      case McapKind::channel:
        add_channel(content, record_at_);
        break;
      case McapKind::data_end:
        check_end(record_at_);
        break;
      case McapKind::message: {
        // Among indexed chunks this is another record with a damaged kind.
        if (ending_ == McapEnding::optional && !indexed_records_.empty()) break;
        auto found = message(content);
        found->payload = std::span<const std::uint8_t>(record_).subspan(
            k_mcap_heading_bytes + k_mcap_message_heading_bytes);
        return found;
      }
      default:
        break;  // indexes, attachments, metadata, kinds of a later version
    }
  }
}

Bytes McapReader::attachment(const McapAttachmentIndex& index) const {
  Bytes bytes;
  file_.read(index.offset + k_mcap_heading_bytes, index.length - k_mcap_heading_bytes, bytes);
  ByteReader content(bytes);
  content.take(16);  // its two times
  (void)content.text();
  (void)content.text();
  const auto data = content.take(content.number<std::uint64_t>());
  const std::size_t checked = content.position();
  const auto expected = content.number<std::uint32_t>();
  if (content.failed()) refuse_content(index.offset, "attachment");
  const std::uint32_t crc = crc32(0, std::span<const std::uint8_t>(bytes).first(checked));
  if (expected != 0 && expected != crc)
    file_.refuse(index.offset, "an attachment with checksum " + std::to_string(crc),
                 std::to_string(expected) + "; the file is damaged here");
  return {data.begin(), data.end()};
}

}  // namespace glint
