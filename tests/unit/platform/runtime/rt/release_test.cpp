#include "platform/runtime/rt/release.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "platform/runtime/rt/clock.hpp"

namespace glint {
namespace {

TEST(Release, IsNotLostWhenItComesBeforeTheWait) {
  Release release;
  release.post();
  release.post();
  release.wait();
  release.wait();
  EXPECT_FALSE(release.wait_until(monotonic_now()));
}

TEST(Release, GivesUpAtTheDeadlineAndNotBefore) {
  Release release;
  const Time deadline = monotonic_now() + milliseconds(3);
  EXPECT_FALSE(release.wait_until(deadline));
  EXPECT_GE(monotonic_now(), deadline);
}

TEST(Release, WakesAWaitingThreadForEachPostAndShowsItWhatWasWritten) {
  constexpr int k_posts = 2000;
  Release there, back;
  int value = 0;
  std::jthread other([&] {
    for (int i = 1; i <= k_posts; ++i) {
      there.wait();
      if (value != i) return;  // the last value then shows the failure
      value = -i;
      back.post();
    }
  });
  int answered = 0;
  for (int i = 1; i <= k_posts; ++i) {
    value = i;
    there.post();
    if (!back.wait_until(monotonic_now() + milliseconds(60'000))) break;
    answered += value == -i ? 1 : 0;
  }
  EXPECT_EQ(answered, k_posts);
}

}  // namespace
}  // namespace glint
