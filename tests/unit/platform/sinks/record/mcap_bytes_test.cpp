// Parses a written file by the MCAP specification, without the writer's or reader's code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "platform/sinks/record/mcap_writer.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint::mcap_bytes_test {
namespace {

using Text = std::string;  // of bytes

constexpr int k_messages = 12;
constexpr std::uint64_t k_attached_at = 77;

// CRC-32 of ISO-HDLC, bit by bit.
std::uint32_t checksum(const Text& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

class Cursor {
 public:
  explicit Cursor(Text bytes) : bytes_(std::move(bytes)) {}
  std::uint64_t number(int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) {
      value |= std::uint64_t{static_cast<std::uint8_t>(bytes_.at(at_++))} << 8 * i;
    }
    return value;
  }
  Text take(std::uint64_t count) {
    const Text taken = bytes_.substr(at_, count);
    EXPECT_EQ(taken.size(), count);
    at_ += count;
    return taken;
  }
  Text text() { return take(number(4)); }
  [[nodiscard]] bool at_end() const { return at_ >= bytes_.size(); }

 private:
  Text bytes_;
  std::size_t at_ = 0;
};

struct Record {
  int kind = 0;
  std::uint64_t offset = 0, length = 0;  // including the heading of nine bytes
  Text content;
};

std::vector<Record> records_of(const Text& bytes, std::uint64_t first) {
  std::vector<Record> records;
  for (std::uint64_t at = 0; at < bytes.size();) {
    Cursor cursor(bytes.substr(at));
    Record record;
    record.kind = static_cast<int>(cursor.number(1));
    const std::uint64_t size = cursor.number(8);
    record.content = cursor.take(size);
    record.offset = first + at;
    record.length = size + 9;
    at += record.length;
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<Record> of_kind(const std::vector<Record>& records, int kind) {
  std::vector<Record> found;
  std::copy_if(records.begin(), records.end(), std::back_inserter(found),
               [&](const Record& record) { return record.kind == kind; });
  return found;
}

class McapBytes : public testing::Test {
 protected:
  McapBytes() {
    McapSettings settings;
    settings.chunk_bytes = 200;
    {
      McapWriter writer(path_, "profile", "library", settings);
      const auto one = writer.add_channel("/one", "pkg/msg/A", "int32 a\n", {{"key", "value"}});
      const auto two = writer.add_channel("/two", "pkg/msg/B", "int32 b\n", {});
      writer.attach("file", "text/plain", k_attached_at, Bytes{1, 2, 3});
      for (int i = 0; i < k_messages; ++i) {
        writer.write({i % 2 == 0 ? one : two, static_cast<std::uint32_t>(i), log_time(i), 5},
                     Bytes(3, static_cast<std::uint8_t>(i)));
      }
      EXPECT_TRUE(writer.close("closing", {{"b", "2"}, {"c", ""}}));
    }
    file_ = text_of(path_);
    EXPECT_GT(file_.size(), 100U);
    const Text magic = "\x89MCAP0\r\n";
    EXPECT_EQ(file_.substr(0, 8), magic);
    EXPECT_EQ(file_.substr(file_.size() - 8), magic);
    all_ = records_of(file_.substr(8, file_.size() - 16), 8);
  }
  ~McapBytes() override { std::remove(path_.c_str()); }

  // Message times decrease.
  static std::uint64_t log_time(int i) { return 1000 - static_cast<std::uint64_t>(i); }
  // Expects a record of this kind and length at this offset.
  void expect_record_at(std::uint64_t offset, std::uint64_t length, int kind) {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const Record& record) {
      return record.offset == offset && record.kind == kind;
    });
    ASSERT_NE(found, all_.end()) << "kind " << kind << " at " << offset;
    EXPECT_EQ(found->length, length) << "kind " << kind << " at " << offset;
  }

  std::string path_ = testing::TempDir() + "walked.mcap";
  Text file_;
  std::vector<Record> all_;
};

TEST_F(McapBytes, BeginWithTheHeaderAndEndWithTheFooter) {
  EXPECT_EQ(all_.front().kind, 1);
  Cursor header(all_.front().content);
  EXPECT_EQ(header.text(), "profile");
  EXPECT_EQ(header.text(), "library");
  EXPECT_TRUE(header.at_end());

  EXPECT_EQ(all_.back().kind, 2);
  Cursor footer(all_.back().content);
  const std::uint64_t summary = footer.number(8), offsets = footer.number(8);
  const std::uint64_t crc = footer.number(4);
  EXPECT_TRUE(footer.at_end());
  // The summary's CRC covers everything before its own field; the magic follows.
  EXPECT_EQ(crc, checksum(file_.substr(summary, file_.size() - 12 - summary)));
  const std::vector<Record> ends = of_kind(all_, 15);
  ASSERT_EQ(ends.size(), 1U);
  EXPECT_EQ(ends[0].offset + ends[0].length, summary);
  EXPECT_EQ(Cursor(ends[0].content).number(4), checksum(file_.substr(0, ends[0].offset)));
  // One summary offset for each kind, in file order.
  std::uint64_t at = summary;
  for (const Record& record : of_kind(all_, 14)) {
    Cursor group(record.content);
    const auto kind = static_cast<int>(group.number(1));
    EXPECT_EQ(group.number(8), at);
    const std::uint64_t end = at + group.number(8);
    for (const Record& inside : all_) {
      if (inside.offset < at || inside.offset >= end) continue;
      EXPECT_EQ(inside.kind, kind);
      at = inside.offset + inside.length;
    }
    EXPECT_EQ(at, end);
  }
  EXPECT_EQ(at, offsets);
}

TEST_F(McapBytes, HoldEachChunkWithItsChecksumItsMessagesAndTheirIndex) {
  std::vector<int> seen;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> times;  // by the chunk's offset
  const std::vector<Record> chunks = of_kind(all_, 6);
  EXPECT_GE(chunks.size(), 2U);
  for (const Record& record : chunks) {
    Cursor chunk(record.content);
    const std::uint64_t start = chunk.number(8), end = chunk.number(8), size = chunk.number(8);
    const std::uint64_t crc = chunk.number(4);
    EXPECT_EQ(chunk.text(), "");
    EXPECT_EQ(chunk.number(8), size);
    const Text inside = chunk.take(size);
    EXPECT_TRUE(chunk.at_end());
    EXPECT_EQ(crc, checksum(inside));
    std::uint64_t first = ~0ULL, last = 0;
    std::map<std::uint64_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> by_channel;
    for (const Record& message : of_kind(records_of(inside, 0), 5)) {
      Cursor cursor(message.content);
      const std::uint64_t channel = cursor.number(2);
      const auto number = static_cast<int>(cursor.number(4));
      const std::uint64_t time = cursor.number(8);
      EXPECT_EQ(channel, static_cast<std::uint64_t>(number % 2));
      EXPECT_EQ(time, log_time(number));
      EXPECT_EQ(cursor.number(8), 5U);
      EXPECT_EQ(cursor.take(3), Text(3, static_cast<char>(number)));
      EXPECT_TRUE(cursor.at_end());
      seen.push_back(number);
      first = std::min(first, time);
      last = std::max(last, time);
      by_channel[channel].emplace_back(time, message.offset);
    }
    EXPECT_EQ(start, first);
    EXPECT_EQ(end, last);
    times[record.offset] = {start, end};
    // The message indexes follow the chunk: one a channel, in order of time.
    std::size_t indexes = 0;
    for (const Record& index : all_) {
      if (index.kind != 7 || index.offset < record.offset) continue;
      if (indexes == by_channel.size()) break;
      ++indexes;
      Cursor cursor(index.content);
      auto expected = by_channel[cursor.number(2)];
      std::sort(expected.begin(), expected.end());
      ASSERT_EQ(cursor.number(4), 16 * expected.size());
      for (const auto& [time, offset] : expected) {
        EXPECT_EQ(cursor.number(8), time);
        EXPECT_EQ(cursor.number(8), offset);
      }
      EXPECT_TRUE(cursor.at_end());
    }
    EXPECT_EQ(indexes, by_channel.size());
  }
  for (int i = 0; i < k_messages; ++i) EXPECT_EQ(seen.at(static_cast<std::size_t>(i)), i);

  const std::vector<Record> indexes = of_kind(all_, 8);
  ASSERT_EQ(indexes.size(), chunks.size());
  for (std::size_t i = 0; i < indexes.size(); ++i) {
    Cursor index(indexes[i].content);
    const std::uint64_t start = index.number(8), end = index.number(8);
    const std::uint64_t offset = index.number(8), length = index.number(8);
    expect_record_at(offset, length, 6);
    EXPECT_EQ(times[offset], std::make_pair(start, end));
    Cursor offsets(index.text());
    const std::uint64_t index_bytes = index.number(8);
    std::uint64_t place = offset + length;
    while (!offsets.at_end()) {
      const std::uint64_t channel = offsets.number(2);
      EXPECT_EQ(offsets.number(8), place);
      const auto found = std::find_if(all_.begin(), all_.end(),
                                      [&](const Record& r) { return r.offset == place; });
      ASSERT_NE(found, all_.end());
      EXPECT_EQ(found->kind, 7);
      EXPECT_EQ(Cursor(found->content).number(2), channel);
      place += found->length;
    }
    EXPECT_EQ(place, offset + length + index_bytes);
    EXPECT_EQ(index.text(), "");
    EXPECT_EQ(index.number(8), length - 9 - 40);  // a chunk's fields without compression: 40 bytes
    EXPECT_EQ(index.number(8), length - 9 - 40);
    EXPECT_TRUE(index.at_end());
  }
}

TEST_F(McapBytes, NameSchemasChannelsAttachmentsAndMetadata) {
  const std::vector<Record> schemas = of_kind(all_, 3), channels = of_kind(all_, 4);
  ASSERT_EQ(schemas.size(), 2U);
  ASSERT_EQ(channels.size(), 2U);
  for (std::uint64_t i = 0; i < 2; ++i) {
    Cursor schema(schemas[i].content), channel(channels[i].content);
    EXPECT_EQ(schema.number(2), i + 1);
    EXPECT_EQ(schema.text(), i == 0 ? "pkg/msg/A" : "pkg/msg/B");
    EXPECT_EQ(schema.text(), "ros2msg");
    EXPECT_EQ(schema.text(), i == 0 ? "int32 a\n" : "int32 b\n");
    EXPECT_TRUE(schema.at_end());
    EXPECT_EQ(channel.number(2), i);
    EXPECT_EQ(channel.number(2), i + 1);
    EXPECT_EQ(channel.text(), i == 0 ? "/one" : "/two");
    EXPECT_EQ(channel.text(), "cdr");
    Cursor metadata(channel.text());
    if (i == 0) {
      EXPECT_EQ(metadata.text(), "key");
      EXPECT_EQ(metadata.text(), "value");
    }
    EXPECT_TRUE(metadata.at_end());
    EXPECT_TRUE(channel.at_end());
  }
  const std::vector<Record> attachments = of_kind(all_, 9), attached = of_kind(all_, 10);
  ASSERT_EQ(attachments.size(), 1U);
  ASSERT_EQ(attached.size(), 1U);
  Cursor attachment(attachments[0].content), place(attached[0].content);
  EXPECT_EQ(attachment.number(8), k_attached_at);
  EXPECT_EQ(attachment.number(8), k_attached_at);
  EXPECT_EQ(attachment.text(), "file");
  EXPECT_EQ(attachment.text(), "text/plain");
  EXPECT_EQ(attachment.take(attachment.number(8)), "\1\2\3");
  const Text& content = attachments[0].content;
  EXPECT_EQ(attachment.number(4), checksum(content.substr(0, content.size() - 4)));
  const std::uint64_t offset = place.number(8);
  expect_record_at(offset, place.number(8), 9);
  EXPECT_EQ(place.number(8), k_attached_at);
  EXPECT_EQ(place.number(8), k_attached_at);
  EXPECT_EQ(place.number(8), 3U);
  EXPECT_EQ(place.text(), "file");
  EXPECT_EQ(place.text(), "text/plain");

  const std::vector<Record> metadata = of_kind(all_, 12), named = of_kind(all_, 13);
  ASSERT_EQ(metadata.size(), 1U);
  ASSERT_EQ(named.size(), 1U);
  Cursor texts(metadata[0].content), index(named[0].content);
  EXPECT_EQ(texts.text(), "closing");
  EXPECT_EQ(texts.text(), Text("\1\0\0\0b\1\0\0\0002\1\0\0\0c\0\0\0\0", 19));
  const std::uint64_t metadata_at = index.number(8);
  expect_record_at(metadata_at, index.number(8), 12);
  EXPECT_EQ(index.text(), "closing");

  const std::vector<Record> statistics = of_kind(all_, 11);
  ASSERT_EQ(statistics.size(), 1U);
  Cursor counts(statistics[0].content);
  EXPECT_EQ(counts.number(8), static_cast<std::uint64_t>(k_messages));
  EXPECT_EQ(counts.number(2), 2U);  // schemas
  EXPECT_EQ(counts.number(4), 2U);  // channels
  EXPECT_EQ(counts.number(4), 1U);  // attachments
  EXPECT_EQ(counts.number(4), 1U);  // metadata
  EXPECT_EQ(counts.number(4), of_kind(all_, 6).size());
  EXPECT_EQ(counts.number(8), log_time(k_messages - 1));
  EXPECT_EQ(counts.number(8), log_time(0));
  Cursor messages(counts.text());
  for (std::uint64_t channel = 0; channel < 2; ++channel) {
    EXPECT_EQ(messages.number(2), channel);
    EXPECT_EQ(messages.number(8), k_messages / 2U);
  }
  EXPECT_TRUE(messages.at_end());
}

}  // namespace
}  // namespace glint::mcap_bytes_test
