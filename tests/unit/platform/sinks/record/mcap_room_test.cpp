// Chunks: where they end, what they contain, and the disk space that is allocated ahead of them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "platform/sinks/record/mcap_reader.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

// Replaces the C library's function: records the end of the space that this thread allocated.
namespace {
thread_local std::uint64_t g_allocated_end = 0;
}  // namespace

extern "C" int fallocate(int descriptor, int mode, off_t offset, off_t length) {
  g_allocated_end = std::max(g_allocated_end, static_cast<std::uint64_t>(offset + length));
  return static_cast<int>(::syscall(SYS_fallocate, descriptor, mode, offset, length));
}

namespace glint::mcap_room_test {
namespace {

struct Record {
  McapKind kind{};
  Bytes bytes;  // with its heading
};

std::vector<Record> records_of(std::span<const std::uint8_t> bytes) {
  std::vector<Record> records;
  while (!bytes.empty()) {
    ByteReader heading(bytes);
    Record record;
    record.kind = static_cast<McapKind>(heading.number<std::uint8_t>());
    const auto length = heading.number<std::uint64_t>() + k_mcap_heading_bytes;
    record.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    bytes = bytes.subspan(length);
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<Record> records_of_file(const std::string& path) {
  const std::string text = text_of(path);
  return records_of(bytes_of(text).subspan(8, text.size() - 16));
}

// The records of each chunk.
std::vector<std::vector<Record>> chunks_of(const std::string& path) {
  std::vector<std::vector<Record>> chunks;
  for (const Record& record : records_of_file(path)) {
    if (record.kind != McapKind::chunk) continue;
    ByteReader content(std::span(record.bytes).subspan(k_mcap_heading_bytes));
    const McapChunkHeading heading = read_chunk_heading(content);
    chunks.push_back(records_of(content.take(heading.record_bytes)));
  }
  return chunks;
}

std::size_t count(const std::vector<Record>& records, McapKind kind) {
  return static_cast<std::size_t>(std::count_if(
      records.begin(), records.end(), [&](const Record& record) { return record.kind == kind; }));
}

// Messages in each chunk of a file with one channel. A record has 31 bytes plus the payload.
std::vector<std::size_t> messages_in_chunks(McapSettings settings,
                                            const std::vector<std::uint64_t>& times) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  McapWriter writer(path, "ros2", "glint", settings);
  const auto channel = writer.add_channel("/a", "a/msg/A", "", {});
  for (const std::uint64_t time : times) writer.write({channel, 0, time, 0}, Bytes(19));
  EXPECT_TRUE(writer.close("end", {}));
  std::vector<std::size_t> counts;
  for (const auto& chunk : chunks_of(path)) counts.push_back(count(chunk, McapKind::message));
  return counts;
}

// 50 bytes a message. The first chunk also contains the schema and the channel.
TEST(McapChunk, EndsWithTheMessageThatReachesItsSize) {
  McapSettings settings;
  const std::vector<std::uint64_t> times(8, 100);
  settings.chunk_bytes = 150;
  auto counts = messages_in_chunks(settings, times);
  ASSERT_GE(counts.size(), 3u);
  EXPECT_EQ(counts[1], 3u) << "exactly three messages";
  settings.chunk_bytes = 151;
  counts = messages_in_chunks(settings, times);
  EXPECT_EQ(counts[1], 4u);
  settings.chunk_bytes = 1;
  EXPECT_EQ(messages_in_chunks(settings, times), std::vector<std::size_t>(8, 1));
  settings.chunk_bytes = 1 << 20;
  EXPECT_EQ(messages_in_chunks(settings, times), std::vector<std::size_t>{8});
}

TEST(McapChunk, EndsWithTheMessageThatReachesItsSpanInEitherDirection) {
  McapSettings settings;
  settings.chunk_span_ns = 1000;
  using Counts = std::vector<std::size_t>;
  EXPECT_EQ(messages_in_chunks(settings, {5000, 5999, 5500}), Counts{3});
  EXPECT_EQ(messages_in_chunks(settings, {5000, 6000, 5500}), (Counts{2, 1}));
  EXPECT_EQ(messages_in_chunks(settings, {5000, 4001, 4500}), Counts{3});
  EXPECT_EQ(messages_in_chunks(settings, {5000, 4000, 4500}), (Counts{2, 1}));
  EXPECT_EQ(messages_in_chunks(settings, {5000, 4500, 5499, 5500, 0}), (Counts{4, 1}));
}

// A reader without the index needs schema and channel once, before the channel's first message.
TEST(McapChunk, DescribesEachChannelBeforeItsFirstMessage) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  McapSettings settings;
  settings.chunk_bytes = 200;
  McapWriter writer(path, "ros2", "glint", settings);
  std::vector<std::uint16_t> channels;
  for (int i = 0; i < 5; ++i) {  // of three schemas
    channels.push_back(
        writer.add_channel("/" + std::to_string(i), "a/msg/" + std::to_string(i % 3), "text", {}));
    EXPECT_EQ(channels.back(), i);
  }
  for (int i = 0; i < 40; ++i)
    writer.write({channels[static_cast<std::size_t>(i / 3 % 4)], 0, 1, 1}, Bytes(3));
  EXPECT_TRUE(writer.close("end", {}));
  std::set<std::uint16_t> schemas, described;
  std::size_t descriptions = 0;
  for (const auto& chunk : chunks_of(path)) {
    for (const Record& record : chunk) {
      ByteReader content(std::span(record.bytes).subspan(k_mcap_heading_bytes));
      if (record.kind == McapKind::schema) schemas.insert(read_schema(content).id);
      if (record.kind == McapKind::channel) {
        const McapChannel channel = read_channel(content);
        EXPECT_TRUE(schemas.contains(channel.schema_id));
        EXPECT_EQ(channel.schema_id, channel.id % 3 + 1);
        described.insert(channel.id);
        ++descriptions;
      }
      if (record.kind == McapKind::message) {
        EXPECT_TRUE(described.contains(read_message_heading(content).channel_id));
      }
    }
  }
  EXPECT_EQ(descriptions, 4u) << "one has no message";
  const std::vector<Record> all = records_of_file(path);
  EXPECT_EQ(count(all, McapKind::schema), 3u) << "in the index";
  EXPECT_EQ(count(all, McapKind::channel), 5u);
}

TEST(McapSummary, HasNoOffsetOfAGroupThatIsEmpty) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  McapWriter writer(path, "ros2", "glint");
  EXPECT_TRUE(writer.close("end", {}));
  std::set<int> kinds;
  for (const Record& record : records_of_file(path)) {
    if (record.kind != McapKind::summary_offset) continue;
    ByteReader content(std::span(record.bytes).subspan(k_mcap_heading_bytes));
    kinds.insert(content.number<std::uint8_t>());
    EXPECT_GT(content.number<std::uint64_t>(), 8u);
    EXPECT_GT(content.number<std::uint64_t>(), 0u);
  }
  EXPECT_EQ(kinds, (std::set<int>{11, 13}));  // statistics and the metadata index
}

struct Load {
  const char* name;
  int channels, chunks, attachments, metadata;
};

// For any size of the index: a file with space for its last chunk also has space for its ending.
TEST(McapRoom, TakenBeforeTheLastPartHoldsTheEnding) {
  constexpr std::uint64_t k_fixed_bytes = 512;  // the ending's fixed records use part of this
  for (const Load& load : {Load{"one of each", 1, 1, 1, 1}, Load{"channels", 60, 1, 0, 0},
                           Load{"chunks", 3, 60, 0, 0}, Load{"attachments", 1, 1, 60, 0},
                           Load{"metadata", 1, 1, 0, 60}, Load{"none", 0, 0, 0, 0}}) {
    SCOPED_TRACE(load.name);
    const TemporaryFolder folder;
    const std::string path = folder.file("a.mcap");
    McapSettings settings;
    settings.chunk_bytes = 1;
    settings.closing_bytes = 100;
    g_allocated_end = 0;
    McapWriter writer(path, "ros2", "glint", settings);
    const auto expect_room = [&] {
      EXPECT_LE(writer.bytes(), g_allocated_end);
      EXPECT_GE(g_allocated_end, writer.bytes() + settings.closing_bytes + k_fixed_bytes);
    };
    expect_room();
    for (int i = 0; i < load.channels; ++i)
      writer.add_channel("/" + std::to_string(i), "a/msg/" + std::to_string(i), "text",
                         {{"key", "value"}});
    for (int i = 0; i < load.metadata; ++i) writer.add_metadata("m" + std::to_string(i), {});
    for (int i = 0; i < load.attachments; ++i)
      writer.attach("a" + std::to_string(i), "text/plain", 0, Bytes(3));
    for (int i = 0; i < load.chunks; ++i)
      for (int c = 0; c < load.channels; ++c)
        writer.write({static_cast<std::uint16_t>(c), 0, 1, 1}, Bytes(3));
    writer.flush_chunk();
    expect_room();
    ASSERT_TRUE(writer.close("end", {{"fact", "true"}}));
    EXPECT_LE(writer.bytes(), g_allocated_end);
    EXPECT_GE(writer.bytes() + settings.closing_bytes + k_fixed_bytes, g_allocated_end)
        << "more than the ending may need";
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(path));
    EXPECT_EQ(writer.messages(), static_cast<std::uint64_t>(load.chunks * load.channels));
  }
}

}  // namespace
}  // namespace glint::mcap_room_test
