// MCAP records: each record that is appended is read back; a truncated record is rejected.
#include "platform/sinks/record/mcap_format.hpp"

#include <gtest/gtest.h>

#include <string>

#include "platform/sinks/record/crc32.hpp"

namespace glint::mcap_format_test {
namespace {

Bytes content_of(const Bytes& record) {
  return {record.begin() + k_mcap_heading_bytes, record.end()};
}

// Reads the record's content with `read`, which must consume all of it and reject every truncation.
template <class Read>
auto read_whole(const Bytes& record, Read read) {
  const Bytes content = content_of(record);
  EXPECT_EQ(get_little_endian(std::span(record).subspan(1, 8)), content.size());
  for (std::size_t length = 0; length < content.size(); ++length) {
    ByteReader part{std::span(content).first(length)};
    (void)read(part);
    EXPECT_TRUE(part.failed()) << length << " of " << content.size();
  }
  ByteReader reader(content);
  auto found = read(reader);
  EXPECT_FALSE(reader.failed());
  EXPECT_TRUE(reader.at_end());
  return found;
}

TEST(McapFormat, GivesBackASchema) {
  Bytes bytes;
  append_record(bytes, McapSchema{0x1234, "name", "encoding", "a longer text"});
  EXPECT_EQ(bytes[0], 3);
  const McapSchema schema = read_whole(bytes, [](ByteReader& r) { return read_schema(r); });
  EXPECT_EQ(schema.id, 0x1234);
  EXPECT_EQ(schema.name, "name");
  EXPECT_EQ(schema.encoding, "encoding");
  EXPECT_EQ(schema.text, "a longer text");
}

TEST(McapFormat, GivesBackAChannel) {
  const McapTexts texts{{"a", "1"}, {"b", ""}, {"", "3"}};
  Bytes bytes;
  append_record(bytes, McapChannel{7, 9, "/topic", "cdr", texts});
  EXPECT_EQ(bytes[0], 4);
  const McapChannel channel = read_whole(bytes, [](ByteReader& r) { return read_channel(r); });
  EXPECT_EQ(channel.id, 7);
  EXPECT_EQ(channel.schema_id, 9);
  EXPECT_EQ(channel.topic, "/topic");
  EXPECT_EQ(channel.encoding, "cdr");
  EXPECT_EQ(channel.metadata, texts);
}

TEST(McapFormat, GivesBackAMessagesHeading) {
  const Bytes payload{1, 2, 3};
  Bytes bytes;
  append_record(bytes, {5, 6, std::uint64_t{7} << 40, std::uint64_t{8} << 40}, payload);
  EXPECT_EQ(bytes[0], 5);
  EXPECT_EQ(bytes.size(), k_mcap_heading_bytes + k_mcap_message_heading_bytes + 3);
  const Bytes content = content_of(bytes);
  ByteReader reader(content);
  const McapMessageHeading heading = read_message_heading(reader);
  EXPECT_EQ(reader.position(), k_mcap_message_heading_bytes);
  EXPECT_EQ(reader.left(), 3u);
  EXPECT_EQ(heading.channel_id, 5);
  EXPECT_EQ(heading.sequence, 6u);
  EXPECT_EQ(heading.log_time, std::uint64_t{7} << 40);
  EXPECT_EQ(heading.publish_time, std::uint64_t{8} << 40);
}

TEST(McapFormat, GivesBackAChunksHeading) {
  Bytes bytes;
  append_chunk_heading(bytes, {1, 2, 3, 4, "zstd", 5});
  append(bytes, Bytes(5, 0));
  EXPECT_EQ(bytes[0], 6);
  const McapChunkHeading heading = read_whole(bytes, [](ByteReader& r) {
    McapChunkHeading read = read_chunk_heading(r);
    (void)r.take(read.record_bytes);
    return read;
  });
  EXPECT_EQ(heading.start, 1u);
  EXPECT_EQ(heading.end, 2u);
  EXPECT_EQ(heading.uncompressed_bytes, 3u);
  EXPECT_EQ(heading.crc, 4u);
  EXPECT_EQ(heading.compression, "zstd");
  EXPECT_EQ(heading.record_bytes, 5u);
}

TEST(McapFormat, GivesBackThePlaceOfAChunk) {
  McapChunkIndex index;
  index.start = 1;
  index.end = 2;
  index.offset = 3;
  index.length = 4;
  Bytes bytes;
  append_record(bytes, index);
  EXPECT_EQ(bytes[0], 8);
  const Bytes content = content_of(bytes);
  ByteReader reader(content);
  const McapChunkIndex back = read_chunk_index(reader);
  EXPECT_EQ(back.start, 1u);
  EXPECT_EQ(back.end, 2u);
  EXPECT_EQ(back.offset, 3u);
  EXPECT_EQ(back.length, 4u);
  ByteReader part{std::span(content).first(31)};
  (void)read_chunk_index(part);
  EXPECT_TRUE(part.failed());
}

TEST(McapFormat, GivesBackThePlaceOfAnAttachment) {
  Bytes bytes;
  append_record(bytes, McapAttachmentIndex{1, 2, 3, 4, 5, "name", "text/plain"});
  EXPECT_EQ(bytes[0], 10);
  const McapAttachmentIndex index =
      read_whole(bytes, [](ByteReader& r) { return read_attachment_index(r); });
  EXPECT_EQ(index.offset, 1u);
  EXPECT_EQ(index.length, 2u);
  EXPECT_EQ(index.log_time, 3u);
  EXPECT_EQ(index.create_time, 4u);
  EXPECT_EQ(index.data_bytes, 5u);
  EXPECT_EQ(index.name, "name");
  EXPECT_EQ(index.media_type, "text/plain");
}

TEST(McapFormat, GivesBackThePlaceOfMetadata) {
  Bytes bytes;
  append_record(bytes, McapMetadataIndex{1, 2, "name"});
  EXPECT_EQ(bytes[0], 13);
  const McapMetadataIndex index =
      read_whole(bytes, [](ByteReader& r) { return read_metadata_index(r); });
  EXPECT_EQ(index.offset, 1u);
  EXPECT_EQ(index.length, 2u);
  EXPECT_EQ(index.name, "name");
}

TEST(McapFormat, GivesBackStatistics) {
  McapStatistics statistics{1, 2, 3, 4, 5, 6, 7, 8, {{9, 10}, {11, 12}}};
  Bytes bytes;
  append_record(bytes, statistics);
  EXPECT_EQ(bytes[0], 11);
  const McapStatistics back = read_whole(bytes, [](ByteReader& r) { return read_statistics(r); });
  EXPECT_EQ(back.messages, 1u);
  EXPECT_EQ(back.schemas, 2u);
  EXPECT_EQ(back.channels, 3u);
  EXPECT_EQ(back.attachments, 4u);
  EXPECT_EQ(back.metadata, 5u);
  EXPECT_EQ(back.chunks, 6u);
  EXPECT_EQ(back.start, 7u);
  EXPECT_EQ(back.end, 8u);
  EXPECT_EQ(back.channel_messages, statistics.channel_messages);
}

// A map's byte length bounds its content: a string beyond it invalidates the map.
TEST(McapFormat, RefusesATextBeyondTheEndOfItsMap) {
  Bytes bytes;
  append_metadata(bytes, "name", {{"key", "value"}});
  Bytes content = content_of(bytes);
  const auto fails = [&content] {
    ByteReader reader(content);
    EXPECT_EQ(reader.text(), "name");
    (void)read_texts(reader);
    return reader.failed();
  };
  EXPECT_FALSE(fails());
  append(content, Bytes(40, 0));  // more bytes follow the map
  EXPECT_FALSE(fails());
  content[4 + 4 + 4] = 4;  // the key's length is one byte too large
  EXPECT_TRUE(fails());
}

// 10 bytes a channel: half an entry invalidates the record.
TEST(McapFormat, RefusesHalfACountOfStatistics) {
  Bytes bytes;
  append_record(bytes, McapStatistics{0, 0, 0, 0, 0, 0, 0, 0, {{9, 10}}});
  Bytes content = content_of(bytes);
  append(content, Bytes(40, 0));
  for (std::uint8_t length = 0; length <= 30; ++length) {
    content[content.size() - 40 - 14] = length;
    ByteReader reader(content);
    (void)read_statistics(reader);
    EXPECT_EQ(reader.failed(), length % 10 != 0) << int{length};
  }
}

TEST(ByteReader, ReadsNothingMoreOnceItLacksAByte) {
  const Bytes bytes{1, 2, 3, 4, 5};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.number<std::uint16_t>(), 0x0201);
  EXPECT_EQ(reader.position(), 2u);
  EXPECT_EQ(reader.left(), 3u);
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.number<std::uint32_t>(), 0u);
  EXPECT_TRUE(reader.failed());
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(reader.number<std::uint8_t>(), 0);
  EXPECT_TRUE(reader.take(0).empty());
  ByteReader exact(bytes);
  EXPECT_EQ(exact.take(5).size(), 5u);
  EXPECT_TRUE(exact.at_end());
  EXPECT_FALSE(exact.failed());
  EXPECT_TRUE(exact.take(~std::uint64_t{0}).empty());
  EXPECT_TRUE(exact.failed());
}

TEST(Crc32, OfNoBytesIsTheStart) {
  EXPECT_EQ(crc32(0, {}), 0u);
  EXPECT_EQ(crc32(0xCBF43926U, {}), 0xCBF43926U);
}

}  // namespace
}  // namespace glint::mcap_format_test
