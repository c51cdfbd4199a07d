#include "platform/sinks/record/mcap_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/sinks/record/crc32.hpp"
#include "platform/sinks/record/mcap_writer.hpp"
#include "tests/unit/platform/sinks/record/mcap_files.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint {
namespace {

TEST(Mcap, CutShortIsRefusedAndTheNextStepIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  Bytes bytes = test::read_whole(path);
  bytes.resize(bytes.size() - 1);
  test::write_whole(path, bytes);
  EXPECT_EQ(test::refusal(path), path + ":byte " + std::to_string(bytes.size()) +
                                     ": the file ends without its index: truncated; expected a "
                                     "closed recording; --allow-truncated reads its complete part");
}

TEST(Mcap, CutAnywhereIsReadUpToItsLastWholeChunkIfAskedFor) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  int most = 0;
  for (std::size_t part = 1; part < 50; ++part) {
    test::write_whole(path, Bytes(bytes.begin(), bytes.begin() + std::ssize(bytes) * part / 50));
    EXPECT_NE(test::refusal(path), "");
    McapReader reader(path, McapEnding::optional);
    EXPECT_TRUE(reader.is_truncated());
    const int count = test::count_messages(reader);
    EXPECT_GE(count, most);
    most = std::max(most, count);
  }
  EXPECT_EQ(most, test::k_messages);
}

// Offset and length of each record of a kind.
std::vector<std::pair<std::size_t, std::size_t>> records_of(const Bytes& file, McapKind wanted) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t at = k_mcap_magic.size(); at + k_mcap_heading_bytes < file.size();) {
    const std::span<const std::uint8_t> bytes(file);
    ByteReader heading(bytes.subspan(at));
    const auto kind = static_cast<McapKind>(heading.number<std::uint8_t>());
    const auto length = k_mcap_heading_bytes + heading.number<std::uint64_t>();
    if (kind == wanted) found.emplace_back(at, length);
    at += length;
  }
  return found;
}

std::uint64_t missing_messages(const McapReader& reader) {
  std::uint64_t count = 0;
  for (const auto& [topic, messages] : reader.losses().messages) count += messages;
  return count;
}

TEST(Mcap, WithADamagedChunkLosesThatChunkAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  ASSERT_GT(chunks.size(), 5U);
  // Damages its kind, its length, its heading and its middle.
  for (const auto& [offset, length] : chunks) {
    for (const std::size_t place : {std::size_t{0}, std::size_t{1}, std::size_t{8}, std::size_t{30},
                                    length / 2, length - 1}) {
      Bytes damaged = bytes;
      damaged[offset + place] ^= 0x10;
      test::write_whole(path, damaged);
      EXPECT_NE(test::refusal(path), "");
      McapReader reader(path, McapEnding::optional);
      const int count = test::count_messages(reader);
      EXPECT_GE(count, test::k_messages - 10) << offset << " + " << place;
      EXPECT_LT(count, test::k_messages) << offset << " + " << place;
      EXPECT_EQ(count + static_cast<int>(missing_messages(reader)), test::k_messages);
      EXPECT_EQ(reader.losses().chunks, 1U);
      EXPECT_EQ(reader.losses().bytes, length);
      EXPECT_FALSE(reader.losses().at_least);
    }
  }
}

TEST(Mcap, ThatIsWholeLosesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  McapReader reader(path, McapEnding::optional);
  EXPECT_FALSE(reader.is_truncated());
  EXPECT_EQ(test::count_messages(reader), test::k_messages);
  EXPECT_FALSE(reader.losses().any());
  EXPECT_FALSE(reader.losses().at_least);
  EXPECT_EQ(reader.losses().chunks, 0U);
}

// A file that ends after its data end has all its messages, even without an index.
TEST(Mcap, CutBehindItsDataEndLosesNothingAndKeepsWhatStandsBetweenItsChunks) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const McapReader whole(path);
  Bytes bytes = test::read_whole(path);
  const auto [offset, length] = records_of(bytes, McapKind::data_end).front();
  bytes.resize(offset + length);
  test::write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  EXPECT_TRUE(reader.is_truncated());
  EXPECT_EQ(test::count_messages(reader), test::k_messages);
  EXPECT_FALSE(reader.losses().any());
  EXPECT_FALSE(reader.losses().at_least);
  EXPECT_EQ(reader.metadata(), whole.metadata());
  ASSERT_EQ(reader.attachments().size(), 1U);
  const McapAttachmentIndex& found = reader.attachments()[0];
  const McapAttachmentIndex& expected = whole.attachments()[0];
  EXPECT_EQ(found.offset, expected.offset);
  EXPECT_EQ(found.length, expected.length);
  EXPECT_EQ(found.log_time, expected.log_time);
  EXPECT_EQ(found.create_time, expected.create_time);
  EXPECT_EQ(found.data_bytes, expected.data_bytes);
  EXPECT_EQ(found.name, expected.name);
  EXPECT_EQ(found.media_type, expected.media_type);
}

// Records between the chunks contain no messages, whether or not the index lists them.
TEST(Mcap, WithADamagedRecordBetweenItsChunksLosesItsBytesAndNoChunk) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  for (const McapKind kind : {McapKind::attachment, McapKind::metadata, McapKind::message_index}) {
    const auto [offset, length] = records_of(bytes, kind).front();
    Bytes damaged = bytes;
    damaged[offset + 5] ^= 0x10;  // length beyond the end of the file
    test::write_whole(path, damaged);
    EXPECT_NE(test::refusal(path), "");
    McapReader reader(path, McapEnding::optional);
    EXPECT_EQ(test::count_messages(reader), test::k_messages);
    EXPECT_EQ(missing_messages(reader), 0U);
    EXPECT_EQ(reader.losses().chunks, 0U) << static_cast<int>(kind);
    EXPECT_GE(reader.losses().bytes, length) << static_cast<int>(kind);
    if (kind == McapKind::message_index) continue;  // lost up to the next record of the index
    EXPECT_EQ(reader.losses().bytes, length) << static_cast<int>(kind);
  }
}

TEST(Mcap, WithADamagedIndexLosesNoMessage) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  Bytes bytes = test::read_whole(path);
  bytes[records_of(bytes, McapKind::statistics).front().first + 12] ^= 1;
  test::write_whole(path, bytes);
  EXPECT_NE(test::refusal(path), "");
  McapReader reader(path, McapEnding::optional);
  EXPECT_EQ(test::count_messages(reader), test::k_messages);
  EXPECT_FALSE(reader.losses().any());
}

TEST(Mcap, CutShortCountsTheBytesAndTheMessagesThatFollow) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  const auto [offset, length] = chunks[3];
  for (const std::size_t left : {std::size_t{5}, length / 2, length - 1}) {
    test::write_whole(path, Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(offset + left)));
    McapReader reader(path, McapEnding::optional);
    (void)test::count_messages(reader);
    EXPECT_EQ(reader.losses().bytes, left);
    EXPECT_EQ(reader.losses().chunks, 0U);
    EXPECT_TRUE(reader.losses().at_least);
    EXPECT_EQ(missing_messages(reader) > 0, left > 5) << left;
  }
}

// In a file without an ending, the data of the last chunk may never have reached the disk.
TEST(Mcap, CutShortWithADamagedChunkLosesThatChunkAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  Bytes damaged(bytes.begin(), bytes.begin() + std::ptrdiff_t(chunks[5].first));
  damaged[chunks[2].first + chunks[2].second / 2] ^= 1;
  test::write_whole(path, damaged);
  McapReader reader(path, McapEnding::optional);
  const int count = test::count_messages(reader);
  EXPECT_GT(missing_messages(reader), 0U);
  EXPECT_EQ(reader.losses().chunks, 1U);
  EXPECT_EQ(reader.losses().bytes, chunks[2].second);
  EXPECT_TRUE(reader.losses().at_least);
  damaged.resize(chunks[2].first);
  test::write_whole(path, damaged);
  McapReader before(path, McapEnding::optional);
  EXPECT_GT(count, test::count_messages(before));
}

TEST(Mcap, WhoseEndTheDiskNeverHeldIsReadUpToTheLastChunkItDid) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  Bytes bytes = test::read_whole(path);
  std::fill(bytes.begin() + std::ssize(bytes) / 3, bytes.end(), std::uint8_t{0});
  test::write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  const int count = test::count_messages(reader);
  EXPECT_GT(count, 0);
  EXPECT_LT(count, test::k_messages);
}

TEST(Mcap, WithAnyByteChangedIsRefusedOrReadsTheSame) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  test::write_file(path);
  const Bytes bytes = test::read_whole(path);
  std::mt19937 random(1);
  int refused = 0, refused_as_well = 0;
  for (int round = 0; round < 500; ++round) {
    Bytes damaged = bytes;
    damaged[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    test::write_whole(path, damaged);
    const std::string why = test::refusal(path);
    if (why.empty()) continue;
    ++refused;
    EXPECT_EQ(why.find(path + ":byte "), 0U) << why;
    EXPECT_NE(why.find("; expected "), std::string::npos) << why;
    try {  // a damaged beginning is refused; otherwise at most one chunk's messages are missing
      McapReader reader(path, McapEnding::optional);
      const int count = test::count_messages(reader);
      EXPECT_GE(count, test::k_messages - 10) << why;
      if (reader.is_truncated()) continue;
      EXPECT_EQ(count + static_cast<int>(missing_messages(reader)), test::k_messages) << why;
    } catch (const InputError& error) {
      ++refused_as_well;
    }
  }
  EXPECT_LT(refused_as_well, 20);  // 50 of about 9 kB
  EXPECT_EQ(refused, 500);         // a checksum covers every byte of such a file
}

TEST(Mcap, WithACompressedChunkIsRefusedByTheNameOfTheCompression) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_header(bytes, "ros2", "other");
  append_chunk_heading(bytes, {1, 2, 100, 0, "zstd", 3});
  append(bytes, Bytes{1, 2, 3});
  const std::uint64_t start = bytes.size();
  append_footer_heading(bytes, start, 0);
  append(bytes, std::uint32_t{0});
  append(bytes, k_mcap_magic);
  test::write_whole(path, bytes);
  // The file is not damaged, so tolerant reading does not help.
  for (const McapEnding ending : {McapEnding::required, McapEnding::optional}) {
    const std::string why = test::refusal(path, ending);
    EXPECT_NE(why.find("compressed with 'zstd'"), std::string::npos) << why;
  }
}

// The checksum is correct: another program wrote this. The rest of the chunk is discarded.
TEST(Mcap, WithAMessageOfNoChannelLosesTheRestOfItsChunk) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_header(bytes, "ros2", "other");
  append_record(bytes, McapChannel{1, 0, "/one", "cdr", {}});
  const auto add_chunk = [&bytes](std::initializer_list<std::uint16_t> channels) {
    Bytes records;
    for (const std::uint16_t channel : channels) append_record(records, {channel, 0, 1, 1}, {});
    append_chunk_heading(bytes, {1, 2, records.size(), 0, "", records.size()});
    append(bytes, records);
  };
  add_chunk({1, 9, 1});
  add_chunk({1, 1});
  test::write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  EXPECT_EQ(test::count_messages(reader), 3);
  EXPECT_EQ(reader.losses().chunks, 1U);
}

TEST(Mcap, WithAMessageMissingDisagreesWithItsStatistics) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_header(bytes, "ros2", "other");
  append(bytes, static_cast<std::uint8_t>(McapKind::data_end));
  append(bytes, std::uint64_t{4});
  append(bytes, std::uint32_t{0});
  const std::uint64_t start = bytes.size();
  McapStatistics statistics;
  statistics.messages = 1;
  append_record(bytes, statistics);
  append_footer_heading(bytes, start, 0);
  append(bytes, std::uint32_t{0});
  append(bytes, k_mcap_magic);
  test::write_whole(path, bytes);
  EXPECT_NE(test::refusal(path).find("0 messages; expected 1"), std::string::npos)
      << test::refusal(path);
}

}  // namespace
}  // namespace glint
