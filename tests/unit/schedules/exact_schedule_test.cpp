#include "schedules/exact_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "random_groups.hpp"
#include "schedules/makespan_bound.hpp"
#include "schedules/static_order.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::exact_schedule_test {
namespace {

// Exhaustive reference: every allocation to cores and every order on each, without pruning.
std::int64_t brute_force(const TaskGroup& group, int cores, std::int64_t core_delay) {
  std::int64_t best = INT64_MAX;
  std::vector<int> sequence(group.nodes.size());
  for (std::size_t n = 0; n < sequence.size(); ++n) sequence[n] = static_cast<int>(n);
  std::size_t assignments = 1;
  for (std::size_t n = 0; n < sequence.size(); ++n) assignments *= static_cast<std::size_t>(cores);
  do {
    for (std::size_t a = 0; a < assignments; ++a) {
      CoreOrders orders(static_cast<std::size_t>(cores));
      std::size_t rest = a;
      for (const int node : sequence) {
        orders[rest % static_cast<std::size_t>(cores)].push_back(node);
        rest /= static_cast<std::size_t>(cores);
      }
      if (const auto times = times_of(group, orders, core_delay)) {
        best = std::min(best, times->makespan_ns);
      }
    }
  } while (std::next_permutation(sequence.begin(), sequence.end()));
  return best;
}

TEST(ExactSchedule, AgreesWithBruteForceOnSmallGraphs) {
  std::mt19937_64 random(1974);
  for (int i = 0; i < test::repetitions(240, 48); ++i) {
    // Few distinct bounds: many nodes look equal but must not be treated as copies.
    const TaskGroup group = random_group(random, 3 + i % 3, 15 + 15 * (i % 4), i % 2 == 0 ? 2 : 9);
    const std::int64_t core_delay = i % 3 * 3;
    const int cores = 2 + i % 2;
    const ExactSchedule found = exact_schedule(group, cores, core_delay);
    EXPECT_TRUE(found.optimal);
    EXPECT_EQ(found.makespan_ns, brute_force(group, cores, core_delay)) << i;
    EXPECT_EQ(found.makespan_ns, times_of(group, found.orders, core_delay)->makespan_ns);
    EXPECT_LE(makespan_lower_bound(group, cores, core_delay), found.makespan_ns);
  }
}

TEST(ExactSchedule, IsNeverLongerThanTheList) {
  std::mt19937_64 random(1969);
  int shorter = 0;
  for (int i = 0; i < 300; ++i) {
    const TaskGroup group = random_group(random, 8 + i % 8, 10 + 10 * (i % 5));
    const std::int64_t core_delay = i % 4;
    const int cores = 2 + i % 3;
    const ExactSchedule found = exact_schedule(group, cores, core_delay, 20'000);
    const CoreOrders listed = list_schedule(group, cores, core_delay);
    const std::int64_t list = times_of(group, listed, core_delay)->makespan_ns;
    if (found.makespan_ns == list) {
      EXPECT_EQ(found.orders, listed) << "of equals the list stays";
    }
    EXPECT_LE(found.makespan_ns, list);
    EXPECT_LE(found.makespan_lower_bound_ns, found.makespan_ns);
    shorter += found.makespan_ns < list ? 1 : 0;
  }
  EXPECT_GT(shorter, 0);  // otherwise the search would gain nothing
  std::printf("shorter than the list in %d of 300\n", shorter);
}

TEST(ExactSchedule, ProvesTheOptimumForAGraphLikeTheTracker) {
  const TaskGroup group = tracker_like_group();
  std::int64_t before = INT64_MAX;
  for (const int cores : {1, 2, 4}) {
    for (const std::int64_t core_delay : {0, 400, 3000, 30'000}) {
      const ExactSchedule found = exact_schedule(group, cores, core_delay);
      EXPECT_LT(found.searched, k_search_nodes_max / 20) << "long before its limit";
      EXPECT_TRUE(found.optimal) << cores << " cores, hand-over " << core_delay;
      EXPECT_EQ(found.makespan_ns, found.makespan_lower_bound_ns);
      std::printf("%d cores, hand-over %lld: %lld ns, %lld sequences\n", cores,
                  static_cast<long long>(core_delay), static_cast<long long>(found.makespan_ns),
                  static_cast<long long>(found.searched));
      if (core_delay == 400) {
        EXPECT_LT(found.makespan_ns, before);
        before = found.makespan_ns;
      }
    }
  }
}

TEST(ExactSchedule, SaysHowFarFromTheOptimumItMayBeWhereTheSearchIsCut) {
  std::mt19937_64 random(3);
  const TaskGroup group = random_group(random, 20, 5);
  const ExactSchedule cut = exact_schedule(group, 3, 2, 5);
  EXPECT_LE(cut.searched, 5);
  EXPECT_TRUE(cut.optimal || cut.makespan_lower_bound_ns < cut.makespan_ns);
}

// Symmetry breaking. Copy two runs beside copy one or after it; after it, and with a third copy, no
// sequence beats the list schedule. Of the empty cores only the first is tried.
TEST(ExactSchedule, TriesEqualNodesInOneOrderAndOneOfTheUntouchedCores) {
  const auto searched = [](int copies, int cores) {
    return exact_schedule(staged_group({{"Copy", copies, 10}}), cores, 0).searched;
  };
  EXPECT_EQ(searched(3, 2), 4);
  EXPECT_EQ(searched(4, 3), 7);
  EXPECT_EQ(searched(4, 2), 0) << "the list's makespan is the least possible";
  EXPECT_EQ(searched(3, 1), 0);
}

TEST(ExactSchedule, TakesNodesThatReadTheSameInAnyOrderForCopies) {
  const auto searched = [](std::vector<int> after) {
    TaskGroup group = staged_group({{"A", 2, 10}, {"B", 3, 10}});
    group.nodes[3].after = std::move(after);
    return exact_schedule(group, 2, 0).searched;
  };
  EXPECT_EQ(searched({1, 0}), searched({0, 1}));
  EXPECT_GT(searched({0}), searched({0, 1}));
}

// Four sequences as above. A fifth step, if allowed, finds the search exhausted.
TEST(ExactSchedule, ProvesTheOptimumByAnExhaustedSearchAlone) {
  const TaskGroup group = staged_group({{"Copy", 3, 10}});
  for (const std::int64_t allowed : {1, 3, 4, 5, 100}) {
    const ExactSchedule found = exact_schedule(group, 2, 0, allowed);
    EXPECT_EQ(found.searched, std::min<std::int64_t>(allowed, 4));
    EXPECT_EQ(found.makespan_ns, 20);
    EXPECT_EQ(found.optimal, allowed > 4) << allowed;
    EXPECT_EQ(found.makespan_lower_bound_ns, allowed > 4 ? 20 : 15) << allowed;
    EXPECT_EQ(found.orders.size(), 2U);
  }
}

TEST(ExactSchedule, KeepsToOneCoreWhereHandingOverCostsMoreThanItGains) {
  const TaskGroup group = staged_group({{"A", 1, 10}, {"B", 2, 10}, {"C", 1, 10}});
  const ExactSchedule found = exact_schedule(group, 2, 100);
  EXPECT_EQ(found.makespan_ns, 40);
  EXPECT_TRUE(found.optimal);
  EXPECT_EQ(found.orders, (CoreOrders{{0, 1, 2, 3}, {}})) << "a list for each core";
}

TEST(MakespanBound, NoOptimumIsBelowIt) {
  // One node, three copies on two cores, one node: two rounds of copies, or three on one core.
  const TaskGroup group = staged_group({{"A", 1, 10}, {"B", 3, 10}, {"C", 1, 10}});
  EXPECT_EQ(time_between_min(30, 2, 0), 15);
  EXPECT_EQ(time_between_min(30, 2, 5), 20);
  EXPECT_EQ(time_between_min(30, 2, 50), 30);
  EXPECT_EQ(makespan_lower_bound(group, 2, 0), 35);
  EXPECT_EQ(makespan_lower_bound(group, 2, 5), 40);
  EXPECT_EQ(makespan_lower_bound(group, 1, 5), 50);
  // Without a precedence path only the work counts, rounded up.
  EXPECT_EQ(makespan_lower_bound(staged_group({{"Copy", 5, 7}}), 2, 5), 18);
  EXPECT_EQ(makespan_lower_bound(staged_group({{"Copy", 2, 7}}), 4, 5), 7);
}

}  // namespace
}  // namespace glint::exact_schedule_test
