// Sequential reader of an MCAP file that checks every length and checksum.
//
// Memory: the largest record. A file without an ending (power failure, incomplete copy) or with a
// damaged record is rejected. On request, its intact part is read; losses() counts the rest.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/sinks/record/input_file.hpp"
#include "platform/sinks/record/mcap_format.hpp"

namespace glint {

enum class McapEnding : std::uint8_t {
  required,  // index, statistics and end mark are required and checked
  optional,  // damaged or missing parts are skipped and counted
};

// Decodes into `to`, which has the decoded size. Returns false for another compression or damaged
// data.
using ChunkDecoder = bool (*)(std::string_view compression, std::span<const std::uint8_t> from,
                              std::span<std::uint8_t> to);

// Skipped data so far; final once next() returned nothing.
struct McapLosses {
  std::uint64_t chunks = 0;  // damaged chunks
  std::uint64_t bytes = 0;   // of these chunks, and after the last complete record
  std::map<std::string, std::uint64_t> messages;  // by topic
  bool at_least = false;  // lower bound of the messages: no statistics give the total
  [[nodiscard]] bool any() const { return bytes > 0 || !messages.empty(); }
};

// Valid until the next call of next().
struct McapMessage {
  const McapChannel* channel = nullptr;
  const McapSchema* schema = nullptr;
  McapMessageHeading heading;
  std::span<const std::uint8_t> payload;
  std::uint64_t file_offset = 0;  // of the containing record or chunk, for error messages
};

class McapReader {
 public:
  // Without a decoder compressed chunks are rejected. Throws InputError: path, byte, value found,
  // value expected.
  explicit McapReader(const std::string& path, McapEnding ending = McapEnding::required,
                      ChunkDecoder decoder = nullptr);

  // Next message in the order of the file; nothing at its end. Throws InputError.
  [[nodiscard]] std::optional<McapMessage> next();

  // Data of the attachment; `index` is one of attachments().
  [[nodiscard]] Bytes attachment(const McapAttachmentIndex& index) const;

  [[nodiscard]] const std::string& profile() const { return profile_; }
  [[nodiscard]] const std::vector<McapAttachmentIndex>& attachments() const { return attachments_; }
  [[nodiscard]] const std::map<std::string, McapTexts>& metadata() const { return metadata_; }
  [[nodiscard]] bool is_truncated() const { return !has_ending_; }
  [[nodiscard]] const McapLosses& losses() const { return losses_; }
  [[nodiscard]] const InputFile& file() const { return file_; }

 private:
  struct Heading {
    McapKind kind{};
    std::uint64_t bytes = 0;  // of the content
  };
  struct IndexedRecord {
    McapKind kind{};
    std::uint64_t length = 0;  // heading included
  };
  [[nodiscard]] bool read_ending();
  [[nodiscard]] bool find_ending();
  void read_summary(std::uint64_t start, std::uint64_t end);
  void scan_complete_records();
  void read_header();
  void read_metadata(const McapMetadataIndex& index);
  void read_metadata_if_intact(const McapMetadataIndex& index);
  void index_record(const Heading& heading, std::uint64_t at);
  [[nodiscard]] Heading heading_at(std::uint64_t offset, std::uint64_t end) const;
  void open_chunk(std::uint64_t offset);
  [[nodiscard]] bool open_record();
  void check_end(std::uint64_t offset);
  [[nodiscard]] std::optional<McapMessage> next_intact();
  void skip_record();
  void skip_tail();
  void count_messages(ByteReader records);
  void count_by_statistics();
  std::optional<McapMessage> message(ByteReader& content);
  std::optional<McapMessage> next_in_chunk();
  void add_schema(ByteReader& content, std::uint64_t offset);
  void add_channel(ByteReader& content, std::uint64_t offset);
  [[noreturn]] void refuse_content(std::uint64_t offset, const char* kind) const;

  InputFile file_;
  std::string profile_;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<McapAttachmentIndex> attachments_;
  std::map<std::string, McapTexts> metadata_;
  std::optional<McapStatistics> statistics_;
  McapEnding ending_;
  ChunkDecoder decoder_;
  bool has_ending_ = false;
  bool has_data_end_ = false;  // the records of all messages are present
  bool ended_ = false;         // next() returned nothing
  bool compressed_ = false;    // with a known compression: not damaged
  std::map<std::uint64_t, IndexedRecord> indexed_records_;  // from the index, by offset
  std::map<std::uint16_t, std::uint64_t> messages_read_;    // by channel
  McapLosses losses_;
  std::uint64_t data_end_ = 0;   // end of the records that next() reads
  std::uint64_t at_ = 0;         // offset of the next record
  std::uint64_t record_at_ = 0;  // offset of the open record
  std::uint64_t messages_ = 0;
  std::uint32_t crc_ = 0;
  Bytes record_;   // the open record, with its heading
  Bytes decoded_;  // decoded records of the open compressed chunk
  std::optional<ByteReader> chunk_;
};

}  // namespace glint
