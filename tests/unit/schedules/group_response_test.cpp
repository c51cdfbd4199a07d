// Response times of groups that share several cores, each part calculated by hand.
#include "schedules/group_response.hpp"

#include <gtest/gtest.h>

#include "random_groups.hpp"

namespace glint::group_response_test {
namespace {

constexpr std::int64_t k_gap = 100'000;

// Groups in order of decreasing priority, each with one node per core.
struct Allocated {
  TaskModel model;
  Plan plan;

  explicit Allocated(int cores) { model.cores = plan.cores = cores; }
  void add(const char* name, std::int64_t bound_ns, const std::vector<int>& cores) {
    const int g = static_cast<int>(model.groups.size());
    model.groups.push_back(staged_group({{"N", static_cast<int>(cores.size()), bound_ns}}));
    model.groups.back().name = name;
    model.groups.back().min_gap_ns = model.groups.back().deadline_ns = k_gap;
    plan.groups.push_back({name, 40 - g, bound_ns, 0, false});
    for (std::size_t n = 0; n < cores.size(); ++n) {
      plan.nodes.push_back({g, static_cast<int>(n), cores[n], 0, bound_ns});
    }
  }
  [[nodiscard]] std::vector<GroupResponse> responses() const {
    return group_responses(model, plan);
  }
};

TEST(GroupResponses, StateWhatTheyAreOf) {
  Allocated allocated(2);
  allocated.add("first", 10, {1});
  allocated.add("second", 20, {0, 1});
  allocated.model.groups[0].jitter_ns = 3;
  allocated.model.groups[0].deadline_ns = 77;
  const auto found = allocated.responses();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "first");
  EXPECT_EQ(found[0].priority, 40);
  EXPECT_EQ(found[0].jitter_ns, 3);
  EXPECT_EQ(found[0].deadline_ns, 77);
  EXPECT_EQ(found[0].times.makespan_ns, 10);
  EXPECT_EQ(found[0].times.core, std::vector<int>{1});
  EXPECT_EQ(found[0].response_ns, 3 + 10);
  EXPECT_EQ(found[1].name, "second");
  EXPECT_EQ(found[1].times.cores_used, 2);
  EXPECT_EQ(found[1].response_ns, 20 + 10);
}

// The higher-priority group occupies each of its cores for its full response; two wake-ups.
TEST(GroupResponses, OfALessUrgentGroupCountAWideOneOnEachCoreThatBothUse) {
  Allocated allocated(2);
  allocated.add("wide", 100, {0, 1});
  allocated.add("both", 200, {0, 1});
  allocated.add("one", 300, {1});
  allocated.model.system.wake_up_ns = 7;
  allocated.model.groups[0].jitter_ns = 5;
  const auto found = allocated.responses();
  const std::int64_t wide = 100 + 2 * 7, both = 200 + 2 * 7 + 2 * wide;
  EXPECT_EQ(found[0].response_ns, 5 + wide);
  EXPECT_EQ(found[1].response_ns, both);
  EXPECT_EQ(found[2].response_ns, 300 + 7 + wide + both);
}

TEST(GroupResponses, CountInterruptsOnEveryCoreInUse) {
  Allocated allocated(3);
  allocated.add("wide", 100, {0, 1, 2});
  allocated.add("one", 100, {1});
  allocated.model.system.interrupt_ns = 2;
  allocated.model.system.interrupt_gap_ns = 1'000;
  const auto found = allocated.responses();
  EXPECT_EQ(found[0].response_ns, 100 + 3 * 2);
  EXPECT_EQ(found[1].response_ns, 100 + 2 + 106);
}

TEST(GroupResponses, CountTheWritesOfTheirOwnAndOfWhatPreemptsThem) {
  Allocated allocated(1);
  allocated.add("first", 100, {0});
  allocated.add("second", 200, {0});
  allocated.model.groups[0].can_writes = 3;
  allocated.model.groups[1].can_writes = 5;
  allocated.model.system.can_write_ns = 10;
  const auto found = allocated.responses();
  EXPECT_EQ(found[0].response_ns, 130);
  EXPECT_EQ(found[1].response_ns, 200 + 50 + 130);
}

// Blocking on each core is the longest slice of lower priority; over several cores it adds up.
TEST(GroupResponses, AreBlockedByTheLongestSliceOfEachCore) {
  Allocated allocated(2);
  allocated.add("both", 100, {0, 1});
  allocated.add("one", 100, {1});
  allocated.add("short", 1, {0});
  allocated.add("long", 1, {0});
  allocated.add("other", 1, {1});
  allocated.model.groups[2].longest_slice_ns = 10;
  allocated.model.groups[3].longest_slice_ns = 30;
  allocated.model.groups[4].longest_slice_ns = 500;
  const auto found = allocated.responses();
  EXPECT_EQ(found[0].blocking_ns, 30 + 500);
  EXPECT_EQ(found[0].response_ns, 100 + 30 + 500);
  EXPECT_EQ(found[1].blocking_ns, 500);
  EXPECT_EQ(found[2].blocking_ns, 30) << "a slice below, not its own";
  EXPECT_EQ(found[3].blocking_ns, 0);
  EXPECT_EQ(found[4].blocking_ns, 0);
}

TEST(GroupResponses, HaveNoBoundBelowAGroupThatHasNone) {
  Allocated allocated(2);
  allocated.add("first", 100, {0});
  allocated.add("starving", 60, {0, 1});
  allocated.add("below", 1, {1});
  allocated.add("elsewhere", 1, {0});
  allocated.model.groups[0].min_gap_ns = 100;  // uses the core fully
  const auto found = allocated.responses();
  EXPECT_EQ(found[0].response_ns, 100);
  EXPECT_FALSE(found[1].response_ns);
  EXPECT_FALSE(found[2].response_ns) << "what is above it on its core has no bound";
  EXPECT_FALSE(found[3].response_ns);
  EXPECT_FALSE(found[1].meets_deadline());
}

TEST(GroupResponses, AreInTimeUpToTheirDeadline) {
  Allocated allocated(1);
  allocated.add("first", 100, {0});
  allocated.model.groups[0].deadline_ns = 100;
  EXPECT_TRUE(allocated.responses()[0].meets_deadline());
  allocated.model.groups[0].deadline_ns = 99;
  EXPECT_FALSE(allocated.responses()[0].meets_deadline());
}

TEST(GroupResponses, TakeAPriorityFromTheModelWhereThePlanHasNone) {
  Allocated allocated(1);
  allocated.add("slow", 200, {0});
  allocated.add("urgent", 100, {0});
  allocated.plan.groups.clear();
  allocated.model.groups[0].priority = 10;
  allocated.model.groups[1].priority = 11;
  const auto found = allocated.responses();
  EXPECT_EQ(found[0].priority, 10);
  EXPECT_EQ(found[1].response_ns, 100);
  EXPECT_EQ(found[0].response_ns, 300);
}

TEST(GroupResponses, OfOrdersThatWaitForEachOtherAreNone) {
  Allocated allocated(1);
  allocated.add("fits", 10, {0});
  allocated.add("tangled", 10, {0, 0});
  allocated.model.groups[1].nodes[1].after = {0};
  ASSERT_TRUE(allocated.responses()[0].response_ns);
  allocated.plan.nodes[1].start_ns = 20;  // its first node after the second, which reads it
  for (const GroupResponse& found : allocated.responses()) EXPECT_FALSE(found.response_ns);
}

}  // namespace
}  // namespace glint::group_response_test
