#include "platform/record/mcap_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "platform/input_error.hpp"
#include "platform/record/crc32.hpp"
#include "platform/record/mcap_writer.hpp"
#include "tests/unit/platform/record/recording_samples.hpp"
#include "tests/unit/text_of.hpp"

namespace glint {
namespace {

constexpr int k_messages = 60;

Bytes payload_of(int i) { return Bytes(static_cast<std::size_t>(i % 17), std::uint8_t(i)); }

// Small chunks, so that the file has many.
void write_file(const std::string& path) {
  McapSettings settings;
  settings.chunk_bytes = 256;
  McapWriter writer(path, "ros2", "glint", settings);
  const auto one = writer.add_channel("/one", "pkg/msg/A", "int32 a\n", {{"key", "value"}});
  const auto two = writer.add_channel("/two", "pkg/msg/B", "int32 b\n", {});
  writer.add_metadata("opening", {{"a", "1"}});
  writer.attach("file", "text/plain", 7, Bytes{1, 2, 3});
  for (int i = 0; i < k_messages; ++i)
    writer.write({i % 3 == 0 ? one : two, std::uint32_t(i), std::uint64_t(1000 - i), 5},
                 payload_of(i));
  EXPECT_TRUE(writer.close("closing", {{"b", "2"}}));
}

Bytes read_whole(const std::string& path) {
  const std::string text = text_of(path);
  return {text.begin(), text.end()};
}

void write_whole(const std::string& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

int count_messages(McapReader& reader) {
  int count = 0;
  while (reader.next()) ++count;
  return count;
}

std::string refusal(const std::string& path, McapEnding ending = McapEnding::required) {
  try {
    McapReader reader(path, ending);
    count_messages(reader);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Crc32, GivesItsCheckValueHoweverTheBytesAreCut) {
  const auto digits = bytes_of("123456789");
  for (std::size_t cut = 0; cut <= digits.size(); ++cut)
    EXPECT_EQ(crc32(crc32(0, digits.first(cut)), digits.subspan(cut)), 0xCBF43926U);
}

TEST(Mcap, GivesBackEveryMessageInTheOrderOfWriting) {
  const TemporaryFolder folder;
  write_file(folder.file("a.mcap"));
  McapReader reader(folder.file("a.mcap"));
  EXPECT_EQ(reader.profile(), "ros2");
  for (int i = 0; i < k_messages; ++i) {
    const auto message = reader.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->channel->topic, i % 3 == 0 ? "/one" : "/two");
    EXPECT_EQ(message->schema->name, i % 3 == 0 ? "pkg/msg/A" : "pkg/msg/B");
    EXPECT_EQ(message->heading.sequence, std::uint32_t(i));
    EXPECT_EQ(message->heading.log_time, std::uint64_t(1000 - i));
    EXPECT_EQ(message->heading.publish_time, 5U);
    EXPECT_EQ(Bytes(message->payload.begin(), message->payload.end()), payload_of(i));
  }
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.metadata().at("opening").at("a"), "1");
  EXPECT_EQ(reader.metadata().at("closing").at("b"), "2");
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachment(reader.attachments()[0]), (Bytes{1, 2, 3}));
}

TEST(Mcap, WithoutAMessageIsStillAFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  McapWriter writer(path, "ros2", "glint");
  ASSERT_TRUE(writer.close("closing", {}));
  McapReader reader(path);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.file().path(), path);
  EXPECT_EQ(reader.file().size(), std::filesystem::file_size(path));
}

TEST(Mcap, OfAnotherKindIsRefusedWithPathAndByte) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_whole(path, {});
  EXPECT_EQ(refusal(path), path +
                               ":byte 0: an empty file; expected the first bytes of an MCAP "
                               "file, 89 4D 43 41 50 30 0D 0A");
  write_whole(path, {'#', 'R', 'O', 'S', 'B', 'A', 'G', ' ', 'V', '2'});
  EXPECT_EQ(refusal(path).find(path + ":byte 0: another kind of file"), 0U);
  EXPECT_EQ(refusal(folder.file("none.mcap")).find(folder.file("none.mcap") + ": No such file"),
            0U);
  EXPECT_NE(refusal("/tmp").find("not a regular file"), std::string::npos);
}

TEST(Mcap, CutShortIsRefusedAndTheNextStepIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  Bytes bytes = read_whole(path);
  bytes.resize(bytes.size() - 1);
  write_whole(path, bytes);
  EXPECT_EQ(refusal(path), path + ":byte " + std::to_string(bytes.size()) +
                               ": the file ends without its index: it was cut short; expected a "
                               "recording that was closed; --allow-truncated reads what is whole");
}

TEST(Mcap, CutAnywhereIsReadUpToItsLastWholeChunkIfAskedFor) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  const Bytes bytes = read_whole(path);
  int most = 0;
  for (std::size_t part = 1; part < 50; ++part) {
    write_whole(path, Bytes(bytes.begin(), bytes.begin() + std::ssize(bytes) * part / 50));
    EXPECT_NE(refusal(path), "");
    McapReader reader(path, McapEnding::optional);
    EXPECT_TRUE(reader.cut_short());
    const int count = count_messages(reader);
    EXPECT_GE(count, most);
    most = std::max(most, count);
  }
  EXPECT_EQ(most, k_messages);
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
  write_file(path);
  const Bytes bytes = read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  ASSERT_GT(chunks.size(), 5U);
  // Damages its kind, its length, its heading and its middle.
  for (const auto& [offset, length] : chunks) {
    for (const std::size_t place : {std::size_t{0}, std::size_t{1}, std::size_t{8}, std::size_t{30},
                                    length / 2, length - 1}) {
      Bytes damaged = bytes;
      damaged[offset + place] ^= 0x10;
      write_whole(path, damaged);
      EXPECT_NE(refusal(path), "");
      McapReader reader(path, McapEnding::optional);
      const int count = count_messages(reader);
      EXPECT_GE(count, k_messages - 10) << offset << " + " << place;
      EXPECT_LT(count, k_messages) << offset << " + " << place;
      EXPECT_EQ(count + static_cast<int>(missing_messages(reader)), k_messages);
      EXPECT_EQ(reader.losses().chunks, 1U);
      EXPECT_EQ(reader.losses().bytes, length);
      EXPECT_FALSE(reader.losses().at_least);
    }
  }
}

TEST(Mcap, ThatIsWholeLosesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  McapReader reader(path, McapEnding::optional);
  EXPECT_FALSE(reader.cut_short());
  EXPECT_EQ(count_messages(reader), k_messages);
  EXPECT_FALSE(reader.losses().any());
  EXPECT_FALSE(reader.losses().at_least);
  EXPECT_EQ(reader.losses().chunks, 0U);
}

// A file that ends after its data end has all its messages, even without an index.
TEST(Mcap, CutBehindItsDataEndLosesNothingAndKeepsWhatStandsBetweenItsChunks) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  const McapReader whole(path);
  Bytes bytes = read_whole(path);
  const auto [offset, length] = records_of(bytes, McapKind::data_end).front();
  bytes.resize(offset + length);
  write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  EXPECT_TRUE(reader.cut_short());
  EXPECT_EQ(count_messages(reader), k_messages);
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
  write_file(path);
  const Bytes bytes = read_whole(path);
  for (const McapKind kind : {McapKind::attachment, McapKind::metadata, McapKind::message_index}) {
    const auto [offset, length] = records_of(bytes, kind).front();
    Bytes damaged = bytes;
    damaged[offset + 5] ^= 0x10;  // length beyond the end of the file
    write_whole(path, damaged);
    EXPECT_NE(refusal(path), "");
    McapReader reader(path, McapEnding::optional);
    EXPECT_EQ(count_messages(reader), k_messages);
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
  write_file(path);
  Bytes bytes = read_whole(path);
  bytes[records_of(bytes, McapKind::statistics).front().first + 12] ^= 1;
  write_whole(path, bytes);
  EXPECT_NE(refusal(path), "");
  McapReader reader(path, McapEnding::optional);
  EXPECT_EQ(count_messages(reader), k_messages);
  EXPECT_FALSE(reader.losses().any());
}

TEST(Mcap, CutShortCountsTheBytesAndTheMessagesThatFollow) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  const Bytes bytes = read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  const auto [offset, length] = chunks[3];
  for (const std::size_t left : {std::size_t{5}, length / 2, length - 1}) {
    write_whole(path, Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(offset + left)));
    McapReader reader(path, McapEnding::optional);
    (void)count_messages(reader);
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
  write_file(path);
  const Bytes bytes = read_whole(path);
  const auto chunks = records_of(bytes, McapKind::chunk);
  Bytes damaged(bytes.begin(), bytes.begin() + std::ptrdiff_t(chunks[5].first));
  damaged[chunks[2].first + chunks[2].second / 2] ^= 1;
  write_whole(path, damaged);
  McapReader reader(path, McapEnding::optional);
  const int count = count_messages(reader);
  EXPECT_GT(missing_messages(reader), 0U);
  EXPECT_EQ(reader.losses().chunks, 1U);
  EXPECT_EQ(reader.losses().bytes, chunks[2].second);
  EXPECT_TRUE(reader.losses().at_least);
  damaged.resize(chunks[2].first);
  write_whole(path, damaged);
  McapReader before(path, McapEnding::optional);
  EXPECT_GT(count, count_messages(before));
}

TEST(Mcap, WhoseEndTheDiskNeverHeldIsReadUpToTheLastChunkItDid) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  Bytes bytes = read_whole(path);
  std::fill(bytes.begin() + std::ssize(bytes) / 3, bytes.end(), std::uint8_t{0});
  write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  const int count = count_messages(reader);
  EXPECT_GT(count, 0);
  EXPECT_LT(count, k_messages);
}

TEST(Mcap, WithAnyByteChangedIsRefusedOrReadsTheSame) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  write_file(path);
  const Bytes bytes = read_whole(path);
  std::mt19937 random(1);
  int refused = 0, refused_as_well = 0;
  for (int round = 0; round < 500; ++round) {
    Bytes damaged = bytes;
    damaged[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    write_whole(path, damaged);
    const std::string why = refusal(path);
    if (why.empty()) continue;
    ++refused;
    EXPECT_EQ(why.find(path + ":byte "), 0U) << why;
    EXPECT_NE(why.find("; expected "), std::string::npos) << why;
    try {  // a damaged beginning is refused; otherwise at most one chunk's messages are missing
      McapReader reader(path, McapEnding::optional);
      const int count = count_messages(reader);
      EXPECT_GE(count, k_messages - 10) << why;
      if (reader.cut_short()) continue;
      EXPECT_EQ(count + static_cast<int>(missing_messages(reader)), k_messages) << why;
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
  write_whole(path, bytes);
  // The file is not damaged, so tolerant reading does not help.
  for (const McapEnding ending : {McapEnding::required, McapEnding::optional}) {
    const std::string why = refusal(path, ending);
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
  write_whole(path, bytes);
  McapReader reader(path, McapEnding::optional);
  EXPECT_EQ(count_messages(reader), 3);
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
  write_whole(path, bytes);
  EXPECT_NE(refusal(path).find("0 messages; expected 1"), std::string::npos) << refusal(path);
}

}  // namespace
}  // namespace glint
