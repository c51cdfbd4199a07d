// Division of work: the merge of the shards returns the whole work's results, and computes nothing.
#include "platform/shards/sharded_work.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

const std::vector<std::string> k_command = {"experiment", "toy"};

// A sum that depends on its order.
double sum_of(ShardedWork& work, int pieces, int& computed) {
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    sum += work.piece([&] {
      ++computed;
      return 1e16 / (1 + i * i) - i;
    });
  }
  return sum;
}

std::vector<std::string> shards_in(const test::TemporaryFolder& folder, int count, int pieces) {
  std::vector<std::string> files;
  for (int number = count; number >= 1; --number) {
    ShardedWork work({"experiment", "--shard", "1/9", "toy", "--shard-file=x"});
    work.compute_shard({number, count}, "program");
    files.push_back(folder.path(std::to_string(number) + ".shard"));
    work.store_in(files.back());
    int computed = 0;
    (void)sum_of(work, pieces, computed);
    EXPECT_EQ(computed, (pieces + count - number) / count);
    EXPECT_TRUE(work.finish());
  }
  return files;
}

TEST(ShardedWork, MergesAnyNumberOfShardsIntoTheWhole) {
  for (const int count : {1, 2, 7, 20}) {
    const test::TemporaryFolder folder;
    ShardedWork whole(k_command);
    int computed = 0;
    const double expected = sum_of(whole, 11, computed);
    EXPECT_FALSE(whole.finish());
    ShardedWork merge({"merge", "FILES"});
    EXPECT_EQ(merge.merge(shards_in(folder, count, 11), "program"), k_command);
    computed = 0;
    EXPECT_EQ(sum_of(merge, 11, computed), expected) << count;
    EXPECT_EQ(computed, 0);
    EXPECT_FALSE(merge.finish());
  }
}

TEST(ShardedWork, RefusesAMergeOfOtherWork) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = shards_in(folder, 2, 5);
  EXPECT_THROW((void)ShardedWork(k_command).merge(files, "another program"), InputError);
  int computed = 0;
  ShardedWork longer(k_command), shorter(k_command), other(k_command);
  (void)longer.merge(files, "program");
  EXPECT_THROW((void)sum_of(longer, 6, computed), InputError);
  (void)shorter.merge(files, "program");
  (void)sum_of(shorter, 4, computed);
  EXPECT_THROW((void)shorter.finish(), InputError);
  (void)other.merge(files, "program");
  EXPECT_THROW((void)other.piece([] { return std::string("text"); }), InputError);
}

TEST(ShardedWork, AnnouncesItsOwnPieces) {
  ShardedWork work(k_command);
  EXPECT_TRUE(work.computes(0));
  work.compute_shard({2, 3}, "program");
  EXPECT_FALSE(work.computes(0));
  EXPECT_TRUE(work.computes(1));
  (void)work.piece([] { return 1; });
  EXPECT_TRUE(work.computes(0));
  EXPECT_TRUE(work.computes(3));
}

}  // namespace
}  // namespace glint
