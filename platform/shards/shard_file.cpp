#include "platform/shards/shard_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/part_file.hpp"
#include "platform/read_file.hpp"
#include "platform/shards/value_text.hpp"
#include "platform/sinks/record/crc32.hpp"

namespace glint {
namespace {

constexpr std::string_view k_first_line = "glint shard file 1\n";
constexpr const char* k_expected = "; expected a file that a command with --shard has written";

std::uint32_t sum_of(std::string_view text) {
  return crc32(0, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

bool belongs(const ShardFile& file) {
  const Shard& shard = file.shard;
  if (shard.count < 1 || shard.count > k_shards_max || file.pieces < 0) return false;
  if (shard.number < 1 || shard.number > shard.count) return false;
  int piece = shard.number - 1;
  for (const PieceResult& result : file.results) {
    if (result.piece != piece) return false;
    piece += shard.count;
  }
  return piece >= file.pieces && piece - shard.count < file.pieces;
}

void require_same(const std::string& path, const std::string& what, const std::string& own,
                  const std::string& first_path, const std::string& first) {
  if (own == first) return;
  throw InputError(path + ": " + what + " is " + own + "; expected " + first + ", as in " +
                   first_path);
}

}  // namespace

void write_shard_file(const std::string& path, const ShardFile& file) {
  std::string text(k_first_line);
  append_value(file, text);
  append_value(sum_of(text), text);
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (const std::string reason = write_file_atomically(path, text); !reason.empty()) {
    throw InputError(path + ": cannot be written: " + reason + "; expected a writable path");
  }
}

ShardFile read_shard_file(const std::string& path) {
  const std::string text = read_file(path, k_data_bytes_max, "a shard file");
  if (!text.starts_with(k_first_line)) throw InputError(path + ": no shard file" + k_expected);
  ValueReader reader(std::string_view(text).substr(k_first_line.size()), path);
  ShardFile file;
  reader.read(file);
  const std::size_t summed = text.size() - reader.bytes_left();
  std::uint32_t sum = 0;
  reader.read(sum);
  reader.end();
  if (sum != sum_of(std::string_view(text).substr(0, summed)) || !belongs(file)) {
    throw InputError(path + ": damaged" + k_expected);
  }
  return file;
}

std::string command_text(const std::vector<std::string>& words) {
  std::string text = "`glint";
  for (const std::string& word : words) {
    const bool is_plain = !word.empty() && word.find_first_of(" '\"\\$&|;<>()*?") == word.npos;
    text += is_plain ? " " + word : " '" + word + "'";
  }
  return text + "`";
}

std::vector<ShardFile> read_all_shards(const std::vector<std::string>& paths) {
  std::vector<ShardFile> shards;
  std::vector<std::string> path_of;  // by shard
  std::size_t first_slot = 0;
  for (const std::string& path : paths) {
    ShardFile file = read_shard_file(path);
    if (shards.empty()) {
      shards.resize(static_cast<std::size_t>(file.shard.count));
      path_of.resize(shards.size());
      first_slot = static_cast<std::size_t>(file.shard.number - 1);
    } else {
      const ShardFile& first = shards[first_slot];
      const std::string& beside = paths.front();
      require_same(path, "program", file.program, beside, first.program);
      require_same(path, "command", command_text(file.command), beside,
                   command_text(first.command));
      require_same(path, "number of shards", std::to_string(file.shard.count), beside,
                   std::to_string(first.shard.count));
      require_same(path, "number of pieces", std::to_string(file.pieces), beside,
                   std::to_string(first.pieces));
    }
    const auto slot = static_cast<std::size_t>(file.shard.number - 1);
    if (!path_of[slot].empty()) {
      throw InputError(path + ": is shard " + std::to_string(slot + 1) + ", as " + path_of[slot] +
                       "; expected each shard once");
    }
    path_of[slot] = path;
    shards[slot] = std::move(file);
  }
  std::string missing;
  for (std::size_t slot = 0; slot < shards.size(); ++slot) {
    if (!path_of[slot].empty()) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(slot + 1) + "/" +
               std::to_string(shards.size());
  }
  if (!missing.empty()) throw InputError("missing shards: " + missing + "; expected each once");
  return shards;
}

}  // namespace glint
