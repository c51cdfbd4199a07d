// Hand-made MCAP files with one fault each: the message states position, fault and expectation.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/sinks/record/crc32.hpp"
#include "platform/sinks/record/mcap_reader.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

namespace glint::mcap_refusals_test {
namespace {

constexpr std::uint64_t k_header_bytes = k_mcap_heading_bytes + 4 + 4 + 4 + 4;  // "ros2", "hand"
constexpr std::uint64_t k_first = 8 + k_header_bytes;                           // record

void append_heading(Bytes& to, int kind, std::uint64_t length) {
  append(to, static_cast<std::uint8_t>(kind));
  append(to, length);
}

Bytes file_with(const Bytes& records) {
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_header(bytes, "ros2", "hand");
  append(bytes, records);
  return bytes;
}

struct Ending {
  Bytes summary;
  std::uint32_t data_crc = 0, summary_crc = 0;
};

// Appends data end, summary and footer; checksums only if given.
Bytes ended(Bytes bytes, const Ending& ending = {}) {
  append_heading(bytes, 15, 4);
  append(bytes, ending.data_crc);
  const std::uint64_t start = bytes.size();
  if (ending.summary.empty())
    append(bytes, Bytes{0x80, 0, 0, 0, 0, 0, 0, 0, 0});  // unknown record kind
  append(bytes, ending.summary);
  append_footer_heading(bytes, start, 0);
  append(bytes, ending.summary_crc);
  append(bytes, k_mcap_magic);
  return bytes;
}

bool decode_by_xor(std::string_view compression, std::span<const std::uint8_t> from,
                   std::span<std::uint8_t> to) {
  if (compression != "zstd" || from.size() != to.size()) return false;
  std::transform(from.begin(), from.end(), to.begin(),
                 [](std::uint8_t byte) { return static_cast<std::uint8_t>(byte ^ 0x55U); });
  return true;
}

class McapRefusals : public testing::Test {
 protected:
  // The reader's message for these bytes without the path; the number of messages if none.
  std::string error_of(const Bytes& bytes, ChunkDecoder decoder = nullptr,
                       McapEnding ending = McapEnding::required) {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    try {
      McapReader reader(path_, ending, decoder);
      int messages = 0;
      while (reader.next()) ++messages;
      return std::to_string(messages);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find(path_ + ":byte "), 0u) << text;
      return text.substr(path_.size() + 6);
    }
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.file("a.mcap");
};

Bytes message_record(std::uint16_t channel = 1, std::size_t payload = 2) {
  Bytes bytes;
  append_record(bytes, {channel, 0, 1, 1}, Bytes(payload));
  return bytes;
}

Bytes channel_and(const Bytes& records) {
  Bytes bytes;
  append_record(bytes, McapChannel{1, 0, "/one", "cdr", {}});
  append(bytes, records);
  return bytes;
}

Bytes chunk_of(const Bytes& records, McapChunkHeading heading = {}) {
  heading.record_bytes = records.size();
  if (heading.compression.empty()) heading.uncompressed_bytes = records.size();
  Bytes bytes;
  append_chunk_heading(bytes, heading);
  append(bytes, records);
  return bytes;
}

TEST_F(McapRefusals, AreNoneForAFileThatIsWhole) {
  EXPECT_EQ(error_of(ended(file_with({}))), "0");
  EXPECT_EQ(error_of(ended(file_with(channel_and(message_record())))), "1") << "without a chunk";
  EXPECT_EQ(error_of(ended(file_with(chunk_of(channel_and(message_record()))))), "1");
  Bytes unknown;
  append_heading(unknown, 0x91, 3);
  append(unknown, Bytes(3));
  append(unknown, channel_and(message_record()));
  EXPECT_EQ(error_of(ended(file_with(unknown))), "1") << "a record of a later version";
  EXPECT_EQ(error_of(ended(file_with(chunk_of(unknown)))), "1");
}

TEST_F(McapRefusals, NameWhatAFooterLacks) {
  Bytes bytes(k_mcap_magic.begin(), k_mcap_magic.end());
  append_footer_heading(bytes, 0, 0);
  append(bytes, std::uint32_t{0});
  append(bytes, k_mcap_magic);
  EXPECT_EQ(error_of(bytes),
            "8: a file without an index; expected an index, as every recording of "
            "Glint has");
  bytes[8] = 3;
  EXPECT_EQ(error_of(bytes),
            "8: no footer; expected a footer record of 20 bytes before the last magic");
  bytes[8] = 2;
  bytes[9] = 21;
  EXPECT_EQ(error_of(bytes),
            "8: no footer; expected a footer record of 20 bytes before the last magic");
  bytes[9] = 20;
  for (const std::uint8_t start : {7, 9}) {
    bytes[17] = start;
    EXPECT_EQ(error_of(bytes), "8: an index at byte " + std::to_string(start) +
                                   "; expected an index inside the file");
  }
  bytes[17] = 8;
  EXPECT_EQ(error_of(bytes), "8: no header; expected a header record right after the first bytes")
      << "an index may be empty";
  bytes.pop_back();
  EXPECT_EQ(error_of(bytes),
            "44: the file ends without its index: truncated; expected a closed recording; "
            "--allow-truncated reads its complete part");
}

TEST_F(McapRefusals, NameARecordThatDoesNotFit) {
  Bytes record;
  append_heading(record, 0, 0);
  const std::string within =
      "; expected a record within the 13 remaining bytes, and at most 268435456";
  EXPECT_EQ(error_of(ended(file_with(record))),
            std::to_string(k_first) + ": a record of kind 0 and 0 bytes" + within);
  record[0] = 0x80;
  record[1] = 13;
  EXPECT_EQ(error_of(ended(file_with(record))), "0") << "up to the last byte";
  record[1] = 14;
  EXPECT_EQ(error_of(ended(file_with(record))),
            std::to_string(k_first) + ": a record of kind 128 and 14 bytes" + within);
  record.resize(8);  // one byte of a heading of nine is missing before the data end's 13 bytes
  Bytes bytes = file_with({});
  const std::uint64_t summary_at = bytes.size();
  append(bytes, record);
  append_footer_heading(bytes, summary_at, 0);
  append(bytes, std::uint32_t{0});
  append(bytes, k_mcap_magic);
  EXPECT_EQ(error_of(bytes), std::to_string(summary_at) + ": 8 bytes; expected a record");
}

TEST_F(McapRefusals, NameAChecksumThatDisagrees) {
  const Bytes inside = channel_and(message_record());
  McapChunkHeading heading;
  heading.crc = crc32(0, inside);
  EXPECT_EQ(error_of(ended(file_with(chunk_of(inside, heading)))), "1");
  const std::string right = std::to_string(heading.crc);
  heading.crc = 7;
  EXPECT_EQ(error_of(ended(file_with(chunk_of(inside, heading)))),
            std::to_string(k_first) + ": a chunk with checksum " + right +
                "; expected 7; the file is damaged here; --allow-truncated reads the other chunks");

  const Bytes bytes = file_with(inside);
  EXPECT_EQ(error_of(ended(bytes, {{}, crc32(0, bytes), 0})), "1");
  EXPECT_EQ(error_of(ended(bytes, {{}, 7, 0})),
            std::to_string(bytes.size()) + ": records with checksum " +
                std::to_string(crc32(0, bytes)) +
                "; expected 7; the file is damaged before this byte");

  const Bytes whole = ended(bytes);
  const std::uint64_t summary_at = bytes.size() + 13;
  const std::uint32_t summary_crc =
      crc32(0, std::span(whole).subspan(summary_at, whole.size() - 12 - summary_at));
  EXPECT_EQ(error_of(ended(bytes, {{}, 0, summary_crc})), "1");
  EXPECT_EQ(error_of(ended(bytes, {{}, 0, 7})),
            std::to_string(summary_at) + ": an index with checksum " + std::to_string(summary_crc) +
                "; expected 7; the file is damaged here");
}

TEST_F(McapRefusals, NameTheKindOfARecordThatIsTooShort) {
  const std::string at = std::to_string(k_first) + ": ";
  const std::string end =
      " record too short for its fields; expected the fields of the MCAP "
      "specification";
  constexpr std::pair<int, const char*> kinds[] = {
      {3, "schema"}, {4, "channel"}, {5, "message"}, {6, "chunk"}, {15, "data end"}};
  for (const auto& [kind, name] : kinds) {
    Bytes record;
    append_heading(record, kind, 3);
    append(record, Bytes(3));
    EXPECT_EQ(error_of(ended(file_with(record))), at + name + end);
    if (kind == 15) continue;
    EXPECT_EQ(error_of(ended(file_with(chunk_of(record)))), kind == 6 ? "0" : at + name + end)
        << "in a chunk, where no chunk is read";
  }
  Bytes schema;
  append_record(schema, McapSchema{0, "name", "encoding", "text"});
  EXPECT_EQ(error_of(ended(file_with(schema))), at + "schema" + end) << "identifiers begin at 1";
  Bytes inside = message_record();
  inside.pop_back();
  EXPECT_EQ(error_of(ended(file_with(chunk_of(channel_and(inside))))), at + "chunk" + end);
  Bytes chunk = chunk_of(channel_and(message_record()));
  chunk[k_mcap_heading_bytes + 16] ^= 1;  // the uncompressed size
  EXPECT_EQ(error_of(ended(file_with(chunk))), at + "chunk" + end);
}

TEST_F(McapRefusals, NameTheChannelThatIsNotDescribed) {
  EXPECT_EQ(error_of(ended(file_with(message_record(9)))),
            std::to_string(k_first) +
                ": a message of channel 9; expected one of a previously described channel");
}

TEST_F(McapRefusals, NameTheIndexThatPointsOutOfTheFile) {
  const std::uint64_t data_end_at = file_with({}).size(), summary_at = data_end_at + 13;
  const auto with_index = [&](auto index, std::uint64_t offset, std::uint64_t length) {
    index.offset = offset;
    index.length = length;
    Ending ending;
    append_record(ending.summary, index);
    return error_of(ended(file_with({}), ending));
  };
  const auto expect_refused = [&](const char* name, const auto& index) {
    const std::string refusal = std::to_string(summary_at) + ": " + name +
                                " record too short for its fields; expected the fields of the "
                                "MCAP specification";
    EXPECT_EQ(with_index(index, summary_at + 1, 9), refusal) << "behind the records";
    EXPECT_EQ(with_index(index, data_end_at, 14), refusal) << "across their end";
    EXPECT_EQ(with_index(index, data_end_at, 8), refusal) << "shorter than a heading";
    EXPECT_EQ(with_index(index, ~std::uint64_t{0}, 9), refusal);
  };
  expect_refused("chunk index", McapChunkIndex{});
  expect_refused("attachment index", McapAttachmentIndex{});
  expect_refused("metadata index", McapMetadataIndex{});
  EXPECT_EQ(with_index(McapChunkIndex{}, 8, 9),
            "8: a record of kind 1 and " + std::to_string(k_header_bytes - 9) +
                " bytes; expected the record of the index; the file is damaged here");
  Ending part;
  append_heading(part.summary, 11, 3);
  append(part.summary, Bytes(3));
  EXPECT_EQ(error_of(ended(file_with({}), part)),
            std::to_string(summary_at) +
                ": summary record too short for its fields; expected "
                "the fields of the MCAP specification");
}

TEST_F(McapRefusals, NameACompressionThatCannotBeRead) {
  Bytes inside = channel_and(message_record());
  McapChunkHeading heading;
  heading.uncompressed_bytes = inside.size();
  heading.crc = crc32(0, inside);
  for (std::uint8_t& byte : inside) byte ^= 0x55;
  const std::string at = std::to_string(k_first) + ": a chunk compressed with '";
  for (const std::string name : {"zstd", "lz4", "a name of twenty bytes"}) {
    heading.compression = name;
    const Bytes bytes = ended(file_with(chunk_of(inside, heading)));
    const std::string shown = at + name.substr(0, 16) + "'; expected ";
    EXPECT_EQ(error_of(bytes), shown + "chunks without compression, as Glint writes them");
    EXPECT_EQ(error_of(bytes, decode_by_xor),
              name == "zstd"  ? "1"
              : name == "lz4" ? shown + "a complete one; the file is damaged here"
                              : shown + "zstd, lz4 or none");
  }
  heading.compression = "zstd";
  heading.uncompressed_bytes = k_mcap_record_bytes_max + 1;
  EXPECT_EQ(error_of(ended(file_with(chunk_of(inside, heading))), decode_by_xor),
            std::to_string(k_first) +
                ": chunk record too short for its fields; expected the "
                "fields of the MCAP specification");
}

TEST_F(McapRefusals, NameMetadataThatIsTooShort) {
  Bytes record;
  append_heading(record, 12, 3);
  append(record, Bytes(3));
  Ending ending;
  append_record(ending.summary, McapMetadataIndex{k_first, 12, "name"});
  const Bytes bytes = ended(file_with(record), ending);
  EXPECT_EQ(error_of(bytes), std::to_string(k_first) +
                                 ": metadata record too short for its fields; expected the fields "
                                 "of the MCAP specification");
  EXPECT_EQ(error_of(bytes, nullptr, McapEnding::optional), "0") << "no message needs it";
}

TEST_F(McapRefusals, NameAnAttachmentThatIsDamaged) {
  const auto said_of = [&](std::uint32_t crc, std::size_t missing) {
    McapAttachmentIndex index{k_first, 0, 1, 2, 3, "name", "text/plain"};
    Bytes record;
    append_attachment_heading(record, index);
    append(record, Bytes{7, 8, 9});
    append(record, crc);
    record.resize(record.size() - missing);
    index.length = record.size();
    put_little_endian(std::span(record).subspan(1, 8), record.size() - k_mcap_heading_bytes);
    Ending ending;
    append_record(ending.summary, index);
    EXPECT_EQ(error_of(ended(file_with(record), ending)), "0") << "asked for by nothing";
    McapReader reader(path_);
    try {
      const Bytes data = reader.attachment(reader.attachments().at(0));
      return std::string(data.begin(), data.end());
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.size() + 6);
    }
  };
  EXPECT_EQ(said_of(0, 0), "\7\10\11") << "without a checksum";
  const std::string found = said_of(1, 0);
  const std::string head = std::to_string(k_first) + ": an attachment with checksum ";
  ASSERT_EQ(found.find(head), 0u) << found;
  const std::string crc = found.substr(head.size(), found.find(';') - head.size());
  EXPECT_EQ(found, head + crc + "; expected 1; the file is damaged here");
  EXPECT_EQ(said_of(static_cast<std::uint32_t>(std::stoul(crc)), 0), "\7\10\11");
  for (const std::size_t missing : {1, 4, 5, 20}) {
    EXPECT_EQ(said_of(0, missing), std::to_string(k_first) +
                                       ": attachment record too short for its fields; expected "
                                       "the fields of the MCAP specification");
  }
}

// One record of the index is invalid: the records before it are not used either.
TEST_F(McapRefusals, LeaveNothingOfAnIndexThatIsNotUsed) {
  Bytes hidden;
  append_metadata(hidden, "ghost", {{"a", "b"}});
  Bytes records;
  append_heading(records, 0x80, hidden.size());  // another program's kind, with arbitrary content
  append(records, hidden);
  append_record(records, McapChannel{1, 3, "/one", "cdr", {}});
  append(records, message_record(1));
  append(records, message_record(2));
  Ending ending;
  append_record(ending.summary, McapSchema{3, "ghost", "", ""});
  append_record(ending.summary, McapChannel{2, 0, "/ghost", "cdr", {}});
  append_record(ending.summary, McapStatistics{9, 0, 0, 0, 0, 0, 0, 0, {{1, 9}}});
  append_record(ending.summary, McapAttachmentIndex{k_first, 9, 0, 0, 0, "ghost", ""});
  append_record(ending.summary, McapMetadataIndex{k_first + 9, hidden.size(), "ghost"});
  McapChunkIndex index;
  index.offset = 8;  // offset of the header
  index.length = 9;
  append_record(ending.summary, index);
  index.length = 8;  // wrong
  append_record(ending.summary, index);
  EXPECT_NE(error_of(ended(file_with(records), ending)).find("chunk index"), std::string::npos);
  McapReader reader(path_, McapEnding::optional);
  EXPECT_TRUE(reader.is_truncated());
  const auto message = reader.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel->topic, "/one");
  EXPECT_EQ(message->schema, nullptr);
  EXPECT_FALSE(reader.next()) << "its channel is described in the index alone";
  EXPECT_TRUE(reader.attachments().empty());
  EXPECT_TRUE(reader.metadata().empty());
  EXPECT_TRUE(reader.losses().messages.empty());
}

// An unknown compression is treated as damage: only the chunk is lost.
TEST_F(McapRefusals, OfACompressionEndTheReadingOnlyWhereTheFileIsSound) {
  McapChunkHeading heading;
  heading.uncompressed_bytes = 10;
  for (const bool known : {false, true}) {
    heading.compression = known ? "lz4" : "lzX";
    Bytes records = chunk_of(Bytes(10), heading);
    append(records, channel_and(message_record()));
    const std::string found = error_of(ended(file_with(records)), nullptr, McapEnding::optional);
    EXPECT_EQ(found.find("compressed with 'lz4'") != std::string::npos, known) << found;
    if (!known) {
      EXPECT_EQ(found, "1");
    }
  }
}

}  // namespace
}  // namespace glint::mcap_refusals_test
