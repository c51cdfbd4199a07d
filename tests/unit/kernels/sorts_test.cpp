// Merge sort and sorting networks: every count, equal keys, and the memory behind the values.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "kernels/merge_sort.hpp"
#include "kernels/sort_pairs.hpp"

namespace glint::sorts_test {
namespace {

// Compared by key only; a lost or duplicated entry shows in `number`.
struct Entry {
  int key = 0;
  int number = 0;
  bool operator<(const Entry& other) const { return key < other.key; }
};

constexpr std::size_t k_capacity = 70;

TEST(MergeSort, LosesAndDoublesNoEntryWhereKeysAreEqual) {
  std::mt19937 random(1);
  for (int count = 0; count <= static_cast<int>(k_capacity); ++count) {
    for (const int keys : {1, 2, 5, 1000}) {
      std::array<Entry, k_capacity> values{}, scratch{};
      for (int i = 0; i < static_cast<int>(k_capacity); ++i) {
        values[static_cast<std::size_t>(i)] = {static_cast<int>(random()) % keys, i};
      }
      const auto before = values;
      merge_sort(values, scratch, count);
      EXPECT_TRUE(std::is_sorted(values.begin(), values.begin() + count)) << count;
      std::vector<bool> seen(k_capacity);
      for (int i = 0; i < count; ++i) {
        const Entry& entry = values[static_cast<std::size_t>(i)];
        ASSERT_LT(entry.number, count);
        EXPECT_FALSE(seen[static_cast<std::size_t>(entry.number)]) << count;
        seen[static_cast<std::size_t>(entry.number)] = true;
        EXPECT_EQ(entry.key, before[static_cast<std::size_t>(entry.number)].key);
      }
      for (std::size_t i = static_cast<std::size_t>(count); i < k_capacity; ++i) {
        EXPECT_EQ(values[i].number, before[i].number) << "behind the values: " << count;
      }
    }
  }
}

// 0-1 principle: a sorting network is correct if it sorts all sequences of zeros and ones. Knuth,
// vol. 3, section 5.3.4, theorem Z.
TEST(SortFour, SortsAllSequencesOfZerosAndOnesAndOfFourNumbers) {
  for (int bits = 0; bits < 16; ++bits) {
    std::array<int, 4> values{bits & 1, bits >> 1 & 1, bits >> 2 & 1, bits >> 3 & 1};
    sort_four(values.data());
    EXPECT_TRUE(std::is_sorted(values.begin(), values.end())) << bits;
  }
  std::array<int, 4> order{1, 2, 3, 4};
  do {
    std::array<int, 4> values = order;
    sort_four(values.data());
    EXPECT_EQ(values, (std::array<int, 4>{1, 2, 3, 4}));
  } while (std::next_permutation(order.begin(), order.end()));
}

// All 0-1 sequences of up to ten values; for more values, those with the ones in one block.
TEST(SortPairs, SortsZerosAndOnesOfEveryNumberOfValues) {
  for (int count = 0; count <= k_sort_pairs_max; ++count) {
    const auto check = [count](const auto& is_one) {
      std::array<double, k_sort_pairs_max> values{};
      int ones = 0;
      for (int i = 0; i < count; ++i) {
        values[static_cast<std::size_t>(i)] = is_one(i) ? 1 : 0;
        ones += is_one(i) ? 1 : 0;
      }
      sort_pairs(values.data(), count);
      for (int i = 0; i < count; ++i) {
        ASSERT_EQ(values[static_cast<std::size_t>(i)], i < count - ones ? 0 : 1)
            << i << " of " << count;
      }
    };
    for (int bits = 0; count <= 10 && bits < 1 << count; ++bits) {
      check([bits](int i) { return (bits >> i & 1) != 0; });
    }
    for (int from = 0; from <= count; ++from) {
      for (int end = from; end <= count; ++end) {
        check([from, end](int i) { return i >= from && i < end; });
      }
    }
  }
}

// The values are padded to 8, 16, 32 or 64; entries behind the padding stay unchanged.
TEST(SortPairs, ChangesNothingBehindThePlacesThatItFillsUp) {
  constexpr double k_mark = -7;
  for (int count = 0; count <= k_sort_pairs_max; ++count) {
    std::array<double, k_sort_pairs_max + 8> values;
    values.fill(k_mark);
    for (int i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = count - i;
    sort_pairs(values.data(), count);
    const int filled = count <= 8 ? 8 : count <= 16 ? 16 : count <= 32 ? 32 : 64;
    for (int i = 0; i < static_cast<int>(values.size()); ++i) {
      const double expected = i < count    ? i + 1
                              : i < filled ? std::numeric_limits<double>::infinity()
                                           : k_mark;
      EXPECT_EQ(values[static_cast<std::size_t>(i)], expected) << i << " of " << count;
    }
  }
}

TEST(TwoDoubles, WorkOnEachLaneByItself) {
  const std::array<double, 2> left{3, -4}, right{-5, 2.25};
  const TwoDoubles a = load_two(left.data()), b = load_two(right.data());
  std::array<double, 2> stored{};
  store_two(a, stored.data());
  EXPECT_EQ(stored, left);
  store_two(minimum(a, b), stored.data());
  EXPECT_EQ(stored, (std::array<double, 2>{-5, -4}));
  store_two(maximum(a, b), stored.data());
  EXPECT_EQ(stored, (std::array<double, 2>{3, 2.25}));
  store_two(broadcast_two(1.5), stored.data());
  EXPECT_EQ(stored, (std::array<double, 2>{1.5, 1.5}));
  store_two(keep_lanes(a < b, b), stored.data());
  EXPECT_EQ(stored, (std::array<double, 2>{0, 2.25}));
  store_two(square_root(TwoDoubles{2.25, 16}), stored.data());
  EXPECT_EQ(stored, (std::array<double, 2>{1.5, 4}));
}

// Also with SIMD lanes: the two zeros are equal, and both functions return the second one.
TEST(TwoDoubles, GiveTheSecondOfTwoThatAreEqual) {
  for (const double sign : {1.0, -1.0}) {
    const TwoDoubles a = broadcast_two(sign * 0.0), b = broadcast_two(-sign * 0.0);
    for (int lane = 0; lane < 2; ++lane) {
      EXPECT_EQ(std::signbit(minimum(a, b)[lane]), std::signbit(-sign));
      EXPECT_EQ(std::signbit(maximum(a, b)[lane]), std::signbit(-sign));
    }
  }
}

}  // namespace
}  // namespace glint::sorts_test
