#include "platform/shards/sharded_work.hpp"

#include <cstddef>
#include <cstdio>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

// The command without the options that select a part of it.
std::vector<std::string> undivided(const std::vector<std::string>& words) {
  std::vector<std::string> command;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    if (name != "--shard" && name != "--shard-file") {
      command.push_back(words[i]);
    } else if (name == words[i]) {
      ++i;  // its value
    }
  }
  return command;
}

// "experiment_noise.2_of_8.shard"
std::string default_file(const std::vector<std::string>& command, const Shard& shard) {
  std::string name;
  for (std::size_t i = 0; i < command.size() && i < 2; ++i) {
    if (command[i].find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789") != std::string::npos)
      break;
    name += (name.empty() ? "" : "_") + command[i];
  }
  return name + "." + std::to_string(shard.number) + "_of_" + std::to_string(shard.count) +
         ".shard";
}

}  // namespace

ShardedWork::ShardedWork(const std::vector<std::string>& command) {
  own_.command = undivided(command);
}

void ShardedWork::compute_shard(const Shard& shard, const std::string& program) {
  mode_ = Mode::shard;
  own_.shard = shard;
  own_.program = program;
}

std::vector<std::string> ShardedWork::merge(const std::vector<std::string>& files,
                                            const std::string& program) {
  merged_ = read_all_shards(files);
  const ShardFile& first = merged_.front();
  if (first.program != program) {
    throw InputError(files.front() + ": program is " + first.program + "; expected " + program +
                     ", which merges");
  }
  mode_ = Mode::merge;
  return first.command;
}

const PieceResult& ShardedWork::stored_result(int piece) const {
  const auto count = static_cast<int>(merged_.size());
  if (piece >= merged_.front().pieces) {
    throw InputError("more pieces of work than the shards hold (" +
                     std::to_string(merged_.front().pieces) + "); expected the shards' input");
  }
  return merged_[static_cast<std::size_t>(piece % count)]
      .results[static_cast<std::size_t>(piece / count)];
}

bool ShardedWork::finish() {
  if (mode_ == Mode::merge && pieces_ != merged_.front().pieces) {
    throw InputError(std::to_string(pieces_) + " pieces of work; expected " +
                     std::to_string(merged_.front().pieces) + ", as in the shards");
  }
  if (mode_ != Mode::shard) return false;
  own_.pieces = pieces_;
  const std::string file = file_.empty() ? default_file(own_.command, own_.shard) : file_;
  write_shard_file(file, own_);
  std::printf("written  %s (%zu of %d pieces)\n", printable(file).c_str(), own_.results.size(),
              pieces_);
  return true;
}

}  // namespace glint
