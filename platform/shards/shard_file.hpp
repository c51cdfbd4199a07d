// File of a shard: which command it divides, and the raw results of its pieces.
#pragma once

#include <string>
#include <vector>

namespace glint {

inline constexpr int k_shards_max = 10'000;

// One of `count` equal parts of a command's work, number 1 to count.
struct Shard {
  int number = 1, count = 1;
};

struct PieceResult {
  int piece = 0;
  std::string text;
};

struct ShardFile {
  std::string program;  // name, version and checksum
  std::vector<std::string> command;
  Shard shard;
  int pieces = 0;  // of the whole command
  std::vector<PieceResult> results;
};

// Throws InputError if the file cannot be written; then nothing of it is left.
void write_shard_file(const std::string& path, const ShardFile& file);

// Throws InputError if the file is not a complete shard file.
[[nodiscard]] ShardFile read_shard_file(const std::string& path);

// Reads the files of a whole command, in any order, and returns them in the order of their shards.
// Throws InputError: of another program, command or number of shards; twice; missing.
[[nodiscard]] std::vector<ShardFile> read_all_shards(const std::vector<std::string>& paths);

// Returns the words as a shell reads them.
[[nodiscard]] std::string command_text(const std::vector<std::string>& words);

}  // namespace glint
