// Budgets: items and steps of a slice, and a step budget shared by several consumers.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/shared_budget.hpp"
#include "kernels/slice_size.hpp"

namespace glint::budgets_test {
namespace {

TEST(SliceSize, IsAtLeastOneItemAndOneStep) {
  for (const int few : {-3, 0, 1}) {
    EXPECT_EQ(SliceSize(few, few).items, 1);
    EXPECT_EQ(SliceSize(few, few).steps, 1);
  }
  EXPECT_EQ(SliceSize(2, 3).items, 2);
  EXPECT_EQ(SliceSize(2, 3).steps, 3);
  EXPECT_EQ(SliceSize(5).steps, SliceSize::k_steps_max);
}

// As many items as the steps allow, at most those requested, at least one.
TEST(SliceSize, HoldsTheItemsThatItsStepsAllow) {
  for (int items = 1; items <= 6; ++items) {
    for (int steps = 1; steps <= 30; ++steps) {
      for (int each = 1; each <= 8; ++each) {
        int fit = 0;
        while (fit < items && (fit + 1) * each <= steps) ++fit;
        EXPECT_EQ(SliceSize(items, steps).items_of(each), std::max(1, fit))
            << items << ' ' << steps << ' ' << each;
      }
    }
  }
}

TEST(StepBudget, IsSpentWhenNothingIsLeft) {
  StepBudget budget(5);
  budget.take(4);
  EXPECT_EQ(budget.left(), 1);
  EXPECT_FALSE(budget.spent());
  budget.take(1);
  EXPECT_TRUE(budget.spent());
  budget.take(2);  // the last item exceeds the budget
  EXPECT_EQ(budget.left(), -2);
  EXPECT_TRUE(budget.spent());
  EXPECT_EQ(StepBudget().left(), SliceSize::k_steps_max);
}

// Slices of one budget each process every item once, and spend the steps of each item.
TEST(StepBudget, EndsAStretchWhereItsStepsEnd) {
  constexpr int k_from = 10, k_end = 25;
  for (int steps = 1; steps <= 50; ++steps) {
    for (int each = 1; each <= 7; ++each) {
      int at = k_from;
      while (at < k_end) {
        StepBudget budget(steps);
        const int end = budget.take_items(at, k_end, each);
        EXPECT_EQ(end - at, std::min(k_end - at, std::max(1, steps / each)));
        EXPECT_EQ(budget.left(), steps - (end - at) * each);
        at = end;
      }
      EXPECT_EQ(at, k_end);
    }
  }
  StepBudget budget(100);
  EXPECT_EQ(budget.take_items(4, 4, 3), 4) << "nothing to do";
  EXPECT_EQ(budget.left(), 100);
}

TEST(SharedBudget, KeepsAShareForEachThatIsStillToCome) {
  SharedBudget budget(10, 4, 3);  // a share for each of four consumers; three are present
  EXPECT_EQ(budget.left(), 40);
  EXPECT_EQ(budget.next_max(), 20);
  budget.spend(5);
  EXPECT_EQ(budget.left(), 35);
  EXPECT_EQ(budget.next_max(), 25);
  budget.spend(25);
  EXPECT_EQ(budget.next_max(), 10) << "the last one has its share";
  budget.spend(10);
  EXPECT_EQ(budget.left(), 0);
}

TEST(SharedBudget, GivesEachAtLeastItsShareWhateverTheOthersSpend) {
  constexpr int k_share = 7, k_consumers_max = 6;
  for (int consumers = 1; consumers <= k_consumers_max; ++consumers) {
    SharedBudget budget(k_share, k_consumers_max, consumers);
    int spent = 0;
    for (int consumer = 0; consumer < consumers; ++consumer) {
      const int limit = budget.next_max();
      EXPECT_GE(limit, k_share);
      budget.spend(limit);  // all that it may spend
      spent += limit;
    }
    EXPECT_EQ(spent, k_share * k_consumers_max);
  }
}

}  // namespace
}  // namespace glint::budgets_test
