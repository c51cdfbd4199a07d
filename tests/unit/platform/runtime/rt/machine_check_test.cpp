#include "platform/runtime/rt/machine_check.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace glint {
namespace {

// A machine as described by its files; by default correctly configured.
class MachineCheckTest : public testing::Test {
 protected:
  MachineCheckTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "glint-XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    write("sys/kernel/realtime", "1");
    write("proc/sys/kernel/sched_rt_runtime_us", "-1");
    write("proc/self/status", "Name:\tglint\nCapEff:\t0000000000000000");
    write("proc/self/limits",
          "Max locked memory         unlimited            unlimited            bytes\n"
          "Max realtime priority     90                   90");
    write("sys/devices/system/cpu/online", "0-1");
    write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
    write("sys/devices/system/cpu/cpu1/cpuidle/state0/latency", "2");
    write("proc/irq/9/effective_affinity_list", "0");
  }
  ~MachineCheckTest() override { std::filesystem::remove_all(root_); }

  void write(const std::string& file, const std::string& text) {
    const std::filesystem::path path = std::filesystem::path(root_) / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  // The single finding after the change.
  std::string single_finding() {
    const MachineCheck check = check_machine({1}, root_);
    EXPECT_EQ(check.timing_faults.size(), 1u);
    return check.timing_faults.empty() ? "" : check.timing_faults[0];
  }
  bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  std::string root_;
};

TEST_F(MachineCheckTest, FindsNothingOnAMachineThatIsSetUp) {
  const MachineCheck check = check_machine({1}, root_);
  EXPECT_TRUE(check.preempt_rt);
  EXPECT_TRUE(check.timing_faults.empty()) << check.timing_faults[0];
}

TEST_F(MachineCheckTest, SeesAKernelWithoutPreemptRt) {
  std::filesystem::remove(root_ + "/sys/kernel/realtime");
  EXPECT_TRUE(contains(single_finding(), "PREEMPT_RT"));
}

TEST_F(MachineCheckTest, SeesThatRealTimeThreadsAreThrottled) {
  write("proc/sys/kernel/sched_rt_runtime_us", "950000");
  EXPECT_TRUE(contains(single_finding(), "sched_rt_runtime_us=-1"));
}

TEST_F(MachineCheckTest, SeesAMissingRightUnlessACapabilityGivesIt) {
  write("proc/self/limits", "Max realtime priority     0                    0");
  EXPECT_TRUE(contains(single_finding(), "SCHED_FIFO"));
  write("proc/self/status", "CapEff:\t0000000000800000");
  EXPECT_TRUE(check_machine({1}, root_).timing_faults.empty());
  write("proc/self/limits", "Max locked memory         65536                65536      bytes");
  EXPECT_TRUE(contains(single_finding(), "memlock"));
}

TEST_F(MachineCheckTest, SeesAGovernorAnIdleStateAndAnInterruptOfOurCoreOnly) {
  write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  EXPECT_TRUE(check_machine({1}, root_).timing_faults.empty());
  write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "schedutil");
  EXPECT_TRUE(contains(single_finding(), "core 1 has the governor \"schedutil\""));
  write("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "performance");
  write("sys/devices/system/cpu/cpu1/cpuidle/state1/latency", "133");
  EXPECT_TRUE(contains(single_finding(), "133 us"));
  write("sys/devices/system/cpu/cpu1/cpuidle/state1/disable", "1");
  write("proc/irq/9/effective_affinity_list", "0-1");
  EXPECT_TRUE(contains(single_finding(), "1 interrupts"));
}

TEST_F(MachineCheckTest, SaysThatThreadsAreNotPinned) {
  write("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  const MachineCheck check = check_machine({-1, -1}, root_);
  ASSERT_EQ(check.timing_faults.size(), 1u);
  EXPECT_TRUE(contains(check.timing_faults[0], "not pinned"));
}

}  // namespace
}  // namespace glint
