// Shard files: complete or refused, and each shard of one command once.
#include "platform/shards/shard_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

// Five pieces in `count` shards.
ShardFile shard_of(int number, int count) {
  ShardFile file{
      "glint of a build", {"experiment", "noise", "--random-seed", "1"}, {number, count}, 5, {}};
  for (int piece = number - 1; piece < 5; piece += count)
    file.results.push_back({piece, "text of " + std::to_string(piece)});
  return file;
}

std::string refusal_of(const std::vector<std::string>& paths) {
  try {
    (void)read_all_shards(paths);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(ShardFile, ReadsAllShardsInAnyOrder) {
  const test::TemporaryFolder folder;
  std::vector<std::string> paths;
  for (const int number : {3, 1, 2}) {
    paths.push_back(folder.path(std::to_string(number)));
    write_shard_file(paths.back(), shard_of(number, 3));
  }
  const std::vector<ShardFile> shards = read_all_shards(paths);
  ASSERT_EQ(shards.size(), 3U);
  for (int number = 1; number <= 3; ++number) {
    const ShardFile& file = shards[static_cast<std::size_t>(number - 1)];
    EXPECT_EQ(file.shard.number, number);
    EXPECT_EQ(file.results.front().text, "text of " + std::to_string(number - 1));
  }
}

TEST(ShardFile, NamesMissingDoubledAndForeignShards) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, const ShardFile& file) {
    write_shard_file(folder.path(name), file);
    return folder.path(name);
  };
  const std::string first = write("first", shard_of(1, 4)), third = write("third", shard_of(3, 4));
  EXPECT_NE(refusal_of({third, first}).find("missing shards: 2/4, 4/4"), std::string::npos)
      << refusal_of({third, first});
  EXPECT_NE(refusal_of({first, third, first}).find("is shard 1"), std::string::npos);
  ShardFile foreign = shard_of(2, 4);
  foreign.command.back() = "2";
  const std::string other_seed = write("other_seed", foreign);
  EXPECT_NE(refusal_of({first, other_seed})
                .find("other_seed: command is `glint experiment noise "
                      "--random-seed 2`; expected `glint experiment "
                      "noise --random-seed 1`"),
            std::string::npos)
      << refusal_of({first, other_seed});
  foreign = shard_of(2, 4);
  foreign.program = "glint of another build";
  EXPECT_NE(
      refusal_of({first, write("other_program", foreign)}).find("program is glint of another"),
      std::string::npos);
  EXPECT_NE(refusal_of({first, write("other_count", shard_of(2, 3))}).find("number of shards is 3"),
            std::string::npos);
}

TEST(ShardFile, RefusesEveryCutAndEveryChangedByte) {
  const test::TemporaryFolder folder;
  const std::string whole = folder.path("whole"), damaged = folder.path("damaged");
  write_shard_file(whole, shard_of(1, 2));
  const std::string bytes = read_file(whole, 1 << 20, "the shard");
  const auto is_refused = [&](const std::string& text) {
    std::ofstream(damaged, std::ios::binary) << text;
    try {
      (void)read_shard_file(damaged);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(is_refused(bytes));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    EXPECT_TRUE(is_refused(bytes.substr(0, at))) << at;
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_TRUE(is_refused(changed)) << at;
  }
}

TEST(ShardFile, IsNotWrittenInPart) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("taken");
  std::filesystem::create_directories(path);
  EXPECT_THROW(write_shard_file(path, shard_of(1, 1)), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(path));
}

}  // namespace
}  // namespace glint
