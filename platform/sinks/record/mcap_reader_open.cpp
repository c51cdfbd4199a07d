// Opening of an MCAP file: by its summary if it has one, else by a scan of its complete records.
#include <algorithm>

#include "platform/input_error.hpp"
#include "platform/sinks/record/crc32.hpp"
#include "platform/sinks/record/mcap_reader.hpp"

namespace glint {

McapReader::McapReader(const std::string& path, McapEnding ending, ChunkDecoder decoder)
    : file_(path), ending_(ending), decoder_(decoder) {
  Bytes magic;
  file_.read(0, std::min<std::uint64_t>(file_.size(), k_mcap_magic.size()), magic);
  if (!std::equal(magic.begin(), magic.end(), k_mcap_magic.begin(), k_mcap_magic.end()))
    file_.refuse(0, magic.empty() ? "an empty file" : "another file format",
                 "the first bytes of an MCAP file, 89 4D 43 41 50 30 0D 0A");
  crc_ = crc32(0, magic);
  at_ = k_mcap_magic.size();
  has_ending_ = find_ending();
  if (!has_ending_) {
    if (ending == McapEnding::required)
      file_.refuse(file_.size(), "the file ends without its index: truncated",
                   "a closed recording; --allow-truncated reads its complete part");
    scan_complete_records();
  }
  read_header();
}

void McapReader::read_header() {
  if (!open_record() || static_cast<McapKind>(record_[0]) != McapKind::header)
    file_.refuse(k_mcap_magic.size(), "no header", "a header record right after the first bytes");
  ByteReader content(std::span<const std::uint8_t>(record_).subspan(k_mcap_heading_bytes));
  profile_ = content.text();
  (void)content.text();  // the library that wrote it
  if (content.failed()) refuse_content(k_mcap_magic.size(), "header");
}

// Returns false if there is no usable ending; discards everything read from it.
bool McapReader::find_ending() {
  if (ending_ == McapEnding::required) return read_ending();
  try {
    return read_ending();
  } catch (const InputError&) {
    schemas_.clear();
    channels_.clear();
    attachments_.clear();
    metadata_.clear();
    statistics_.reset();
    indexed_records_.clear();
    return false;
  }
}

// Returns false if there is no footer. Throws if the footer or the summary is invalid.
bool McapReader::read_ending() {
  const std::uint64_t ending_bytes = k_mcap_footer_bytes + k_mcap_magic.size();
  if (file_.size() < k_mcap_magic.size() + ending_bytes) return false;
  const std::uint64_t footer_at = file_.size() - ending_bytes;
  Bytes bytes;
  file_.read(footer_at, ending_bytes, bytes);
  if (!std::equal(k_mcap_magic.begin(), k_mcap_magic.end(), bytes.end() - k_mcap_magic.size()))
    return false;
  ByteReader reader(bytes);
  const auto kind = reader.number<std::uint8_t>();
  const auto length = reader.number<std::uint64_t>();
  const auto start = reader.number<std::uint64_t>();
  (void)reader.number<std::uint64_t>();  // start of the summary offsets
  const std::uint64_t checked = reader.position();
  const auto expected = reader.number<std::uint32_t>();
  if (static_cast<McapKind>(kind) != McapKind::footer ||
      length != k_mcap_footer_bytes - k_mcap_heading_bytes)
    file_.refuse(footer_at, "no footer", "a footer record of 20 bytes before the last magic");
  if (start == 0)
    file_.refuse(footer_at, "a file without an index", "an index, as every recording of Glint has");
  if (start < k_mcap_magic.size() || start > footer_at)
    file_.refuse(footer_at, "an index at byte " + std::to_string(start),
                 "an index inside the file");
  Bytes summary;
  file_.read(start, footer_at - start, summary);
  const std::uint32_t crc =
      crc32(crc32(0, summary), std::span<const std::uint8_t>(bytes).first(checked));
  if (expected != 0 && expected != crc)
    file_.refuse(start, "an index with checksum " + std::to_string(crc),
                 std::to_string(expected) + "; the file is damaged here");
  data_end_ = start;
  read_summary(start, footer_at);
  return true;
}

void McapReader::read_metadata_if_intact(const McapMetadataIndex& index) {
  try {
    read_metadata(index);
  } catch (const InputError&) {
    if (ending_ == McapEnding::required) throw;
  }
}

void McapReader::read_summary(std::uint64_t start, std::uint64_t end) {
  const auto inside = [&](std::uint64_t offset, std::uint64_t length) {
    return length >= k_mcap_heading_bytes && offset <= start && length <= start - offset;
  };
  Bytes bytes;
  for (std::uint64_t at = start; at < end;) {
    const Heading heading = heading_at(at, end);
    file_.read(at + k_mcap_heading_bytes, heading.bytes, bytes);
    ByteReader content(bytes);
    if (heading.kind == McapKind::schema) add_schema(content, at);
    if (heading.kind == McapKind::channel) add_channel(content, at);
    if (heading.kind == McapKind::statistics) statistics_ = read_statistics(content);
    if (heading.kind == McapKind::chunk_index) {
      const McapChunkIndex index = read_chunk_index(content);
      if (!inside(index.offset, index.length)) refuse_content(at, "chunk index");
      indexed_records_[index.offset] = {McapKind::chunk, index.length};
    }
    if (heading.kind == McapKind::attachment_index) {
      attachments_.push_back(read_attachment_index(content));
      const McapAttachmentIndex& index = attachments_.back();
      if (!inside(index.offset, index.length)) refuse_content(at, "attachment index");
      indexed_records_[index.offset] = {McapKind::attachment, index.length};
    }
    if (heading.kind == McapKind::metadata_index) {
      const McapMetadataIndex index = read_metadata_index(content);
      if (!inside(index.offset, index.length)) refuse_content(at, "metadata index");
      indexed_records_[index.offset] = {McapKind::metadata, index.length};
      read_metadata_if_intact(index);
    }
    if (content.failed()) refuse_content(at, "summary");
    at += k_mcap_heading_bytes + heading.bytes;
  }
}

// Stores a record's metadata or attachment, which the missing index would have listed.
void McapReader::index_record(const Heading& heading, std::uint64_t at) {
  const std::uint64_t whole = k_mcap_heading_bytes + heading.bytes;
  if (heading.kind == McapKind::metadata) read_metadata({at, whole, ""});
  if (heading.kind != McapKind::attachment) return;
  Bytes bytes;
  file_.read(at + k_mcap_heading_bytes, heading.bytes, bytes);
  ByteReader content(bytes);
  McapAttachmentIndex index{at, whole, 0, 0, 0, "", ""};
  index.log_time = content.number<std::uint64_t>();
  index.create_time = content.number<std::uint64_t>();
  index.name = content.text();
  index.media_type = content.text();
  index.data_bytes = content.number<std::uint64_t>();
  if (!content.failed()) attachments_.push_back(index);
}

// Scans the records up to the first truncated one.
void McapReader::scan_complete_records() {
  data_end_ = k_mcap_magic.size();
  try {
    while (data_end_ < file_.size()) {
      const Heading heading = heading_at(data_end_, file_.size());
      has_data_end_ = heading.kind == McapKind::data_end;
      if (has_data_end_) return;
      try {
        index_record(heading, data_end_);
      } catch (const InputError&) {
        // Damaged: it is not listed.
      }
      data_end_ += k_mcap_heading_bytes + heading.bytes;
    }
  } catch (const InputError&) {
    // Truncated record: the complete part of the file ends before it.
  }
}

}  // namespace glint
