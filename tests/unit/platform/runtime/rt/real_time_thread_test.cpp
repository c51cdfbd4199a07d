#include "platform/runtime/rt/real_time_thread.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <array>

#include "platform/runtime/rt/memory_lock.hpp"
#include "platform/runtime/rt/worker_rest.hpp"

namespace glint {
namespace {

TEST(RealTimeThread, HasItsNameCutToWhatTheSystemShows) {
  std::array<char, 16> name{};
  RealTimeThread thread({"a_name_that_is_too_long"},
                        [&] { pthread_getname_np(pthread_self(), name.data(), name.size()); });
  thread.join();
  EXPECT_STREQ(name.data(), "a_name_that_is_");
}

TEST(RealTimeThread, ReportsWhatItGotBeforeItsBodyRuns) {
  int policy = -1;
  int core = -1;
  const int here = sched_getcpu();
  RealTimeThread thread({"rt", here, 10}, [&] {
    sched_param parameter{};
    pthread_getschedparam(pthread_self(), &policy, &parameter);
    core = sched_getcpu();
  });
  const ThreadReport report = thread.report();
  thread.join();
  EXPECT_EQ(report.real_time, policy == SCHED_FIFO);
  EXPECT_TRUE(!report.pinned || core == here);
  EXPECT_EQ(report.refused.empty(), report.pinned && report.real_time) << report.refused;
}

// An invalid priority is refused on every machine, even to a privileged process.
TEST(RealTimeThread, RunsIdleWhereItIsToGiveWayAndItsPriorityIsRefused) {
  for (const bool idle_if_refused : {true, false}) {
    int policy = -1;
    ThreadSettings settings{"slices", -1, 100};
    settings.idle_if_refused = idle_if_refused;
    RealTimeThread thread(settings, [&] {
      sched_param parameter{};
      pthread_getschedparam(pthread_self(), &policy, &parameter);
    });
    const std::string refused = thread.report().refused;
    thread.join();
    EXPECT_EQ(policy, idle_if_refused ? SCHED_IDLE : SCHED_OTHER);
    EXPECT_EQ(refused.find("SCHED_FIFO 100: "), 0U) << refused;
    EXPECT_EQ(refused.find("(SCHED_IDLE instead)") != std::string::npos, idle_if_refused)
        << refused;
  }
}

TEST(RealTimeThread, GoesOnWithoutACoreThatIsNotThere) {
  bool ran = false;
  RealTimeThread thread({"rt", 100'000}, [&] { ran = true; });
  thread.join();
  EXPECT_TRUE(ran);
  EXPECT_FALSE(thread.report().pinned);
  EXPECT_EQ(thread.report().refused.substr(0, 12), "core 100000:");
}

TEST(WorkerRest, SpinsLongOnlyWhereEveryThreadGotACoreAndRealTimeRights) {
  ThreadReport granted;
  granted.pinned = granted.real_time = true;
  ThreadReport refused = granted;
  refused.real_time = false;
  EXPECT_EQ(WorkerWaitPolicy({granted}, 100'000).spins_max(), 100'000u);
  EXPECT_EQ(WorkerWaitPolicy({granted, refused}, 100'000).spins_max(),
            WorkerWaitPolicy::k_shared_core_spins_max);
}

TEST(MemoryLock, SaysWhyWhereItIsRefused) {
  const MemoryLock lock = lock_memory();
  EXPECT_EQ(lock.locked, lock.refused.empty()) << lock.refused;
}

}  // namespace
}  // namespace glint
