// Writer of an MCAP file: uncompressed chunks, all checksums, indexes and statistics.
//
// Memory: one chunk, and per chunk written about 100 bytes plus 10 per channel, until the end.
// Before a chunk is written, disk space is reserved for it and for the file's ending. If there is
// none, the recording ends with the previous chunk, complete and readable: see failed().
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kernels/units.hpp"
#include "platform/sinks/record/growing_file.hpp"
#include "platform/sinks/record/mcap_format.hpp"

namespace glint {

struct McapSettings {
  std::size_t chunk_bytes = std::size_t{4} << 20;
  std::uint64_t chunk_span_ns = 1'000'000'000;
  std::size_t closing_bytes = std::size_t{32} << 10;  // space for metadata written before close()
  Duration sync_period = milliseconds(1000);          // period of synchronisation to the disk
};

class McapWriter {
 public:
  // Throws InputError if the file cannot be created.
  McapWriter(const std::string& path, std::string_view profile, std::string_view library,
             McapSettings settings = {});

  // Schemas are identified by name. Returns the number for McapMessageHeading::channel_id.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            const std::string& schema_text, const McapTexts& metadata);

  // After a failure these functions do nothing. Requires a heading.channel_id from add_channel().
  void write(const McapMessageHeading& heading, std::span<const std::uint8_t> payload);
  void attach(const std::string& name, const std::string& media_type, std::uint64_t time_ns,
              std::span<const std::uint8_t> data);
  void add_metadata(const std::string& name, const McapTexts& texts);

  // Writes the buffered chunk; failed() is then final for all messages so far.
  void flush_chunk();

  // Writes metadata of at most closing_bytes, indexes and statistics; then renames the file.
  // Returns false on failure: part_path() remains, error() holds the reason.
  bool close(const std::string& metadata_name, const McapTexts& metadata);

  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] const std::string& error() const { return file_.error(); }
  [[nodiscard]] const std::string& part_path() const { return file_.part_path(); }
  [[nodiscard]] std::uint64_t bytes() const { return file_.size(); }
  [[nodiscard]] std::uint64_t messages() const { return statistics_.messages; }  // in the file

 private:
  struct Summary {
    Bytes records, offsets;
  };
  struct Chunk {
    Bytes records;
    std::map<std::uint16_t, McapMessageTimes> times;
    std::uint64_t start = 0, end = 0, messages = 0;
  };
  bool append_reserved(std::initializer_list<std::span<const std::uint8_t>> parts);
  void put_metadata(const std::string& name, const McapTexts& texts);
  [[nodiscard]] std::uint64_t ending_bytes() const;
  [[nodiscard]] Summary make_summary() const;

  McapSettings settings_;
  GrowingFile file_;
  bool failed_ = false;
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<bool> described_;  // the channel is described in a chunk of the file or in this one
  Chunk chunk_;
  std::vector<McapChunkIndex> chunk_indexes_;
  std::vector<McapAttachmentIndex> attachment_indexes_;
  std::vector<McapMetadataIndex> metadata_indexes_;
  McapStatistics statistics_;
  std::uint64_t index_bytes_ = 0;  // of all indexes and descriptions in the summary so far
};

}  // namespace glint
