// Scheduling policy of the second worker in a run without real time.
#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

// Scheduling policies of this process's threads named `name`.
std::set<int> policies_of(const std::string& name) {
  std::set<int> policies;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::ifstream(task.path() / "comm") >> comm;
    if (comm == name) policies.insert(sched_getscheduler(std::stoi(task.path().filename())));
  }
  return policies;
}

TEST(RunInOrder, AsksForNoRealTimeRightsForItsWorkers) {
  const TemporaryFolder folder;
  Cell cell = short_cell(0.3);
  cell.workers = 2;
  SessionOptions options;
  options.out = folder.path();
  std::set<int> policies;
  options.progress = [&](double, double) { policies.merge(policies_of("glint-worker")); };
  const SessionResult result = run_simulated(cell, options);
  EXPECT_EQ(policies, std::set<int>{SCHED_OTHER});
  EXPECT_TRUE(result.refused.empty()) << result.refused.front();
}

}  // namespace
}  // namespace glint
