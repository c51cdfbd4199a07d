#include "platform/sinks/record/mcap_format.hpp"

namespace glint {

McapTexts read_texts(ByteReader& reader) {
  McapTexts texts;
  ByteReader content = reader.part(reader.number<std::uint32_t>());
  while (!content.at_end()) {
    std::string name = content.text();
    std::string text = content.text();
    if (content.failed()) {
      reader.take(~std::uint64_t{0});  // fails the containing record, too
      return texts;
    }
    texts[std::move(name)] = std::move(text);
  }
  return texts;
}

McapSchema read_schema(ByteReader& reader) {
  McapSchema schema;
  schema.id = reader.number<std::uint16_t>();
  schema.name = reader.text();
  schema.encoding = reader.text();
  schema.text = reader.text();
  return schema;
}

McapChannel read_channel(ByteReader& reader) {
  McapChannel channel;
  channel.id = reader.number<std::uint16_t>();
  channel.schema_id = reader.number<std::uint16_t>();
  channel.topic = reader.text();
  channel.encoding = reader.text();
  channel.metadata = read_texts(reader);
  return channel;
}

McapMessageHeading read_message_heading(ByteReader& reader) {
  McapMessageHeading heading;
  heading.channel_id = reader.number<std::uint16_t>();
  heading.sequence = reader.number<std::uint32_t>();
  heading.log_time = reader.number<std::uint64_t>();
  heading.publish_time = reader.number<std::uint64_t>();
  return heading;
}

McapChunkHeading read_chunk_heading(ByteReader& reader) {
  McapChunkHeading heading;
  heading.start = reader.number<std::uint64_t>();
  heading.end = reader.number<std::uint64_t>();
  heading.uncompressed_bytes = reader.number<std::uint64_t>();
  heading.crc = reader.number<std::uint32_t>();
  heading.compression = reader.text();
  heading.record_bytes = reader.number<std::uint64_t>();
  return heading;
}

McapChunkIndex read_chunk_index(ByteReader& reader) {
  McapChunkIndex index;
  index.start = reader.number<std::uint64_t>();
  index.end = reader.number<std::uint64_t>();
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  return index;
}

McapAttachmentIndex read_attachment_index(ByteReader& reader) {
  McapAttachmentIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.log_time = reader.number<std::uint64_t>();
  index.create_time = reader.number<std::uint64_t>();
  index.data_bytes = reader.number<std::uint64_t>();
  index.name = reader.text();
  index.media_type = reader.text();
  return index;
}

McapMetadataIndex read_metadata_index(ByteReader& reader) {
  McapMetadataIndex index;
  index.offset = reader.number<std::uint64_t>();
  index.length = reader.number<std::uint64_t>();
  index.name = reader.text();
  return index;
}

McapStatistics read_statistics(ByteReader& reader) {
  McapStatistics statistics;
  statistics.messages = reader.number<std::uint64_t>();
  statistics.schemas = reader.number<std::uint16_t>();
  statistics.channels = reader.number<std::uint32_t>();
  statistics.attachments = reader.number<std::uint32_t>();
  statistics.metadata = reader.number<std::uint32_t>();
  statistics.chunks = reader.number<std::uint32_t>();
  statistics.start = reader.number<std::uint64_t>();
  statistics.end = reader.number<std::uint64_t>();
  ByteReader counts = reader.part(reader.number<std::uint32_t>());
  while (!counts.at_end()) {
    const auto id = counts.number<std::uint16_t>();
    statistics.channel_messages[id] = counts.number<std::uint64_t>();
  }
  if (counts.failed()) reader.take(~std::uint64_t{0});
  return statistics;
}

}  // namespace glint
