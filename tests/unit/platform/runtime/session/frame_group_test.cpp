// Published estimates of the frame group for overrun frames, for any read pattern.
#include "platform/runtime/session/frame_group.hpp"

#include <optional>
#include <vector>

#include "nodes/overrun_effects.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sources/scenario_of.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

using graph::OverrunPolicy;

// One frame in time, four successive overruns, one in time, one overrun. At the third overrun the
// head pose is unknown: the prediction keeps the last valid one.
constexpr int k_first = 4, k_checked = 7, k_without_head = k_first + 3;
constexpr bool k_late_frames[k_checked] = {false, true, true, true, true, false, true};

bool is_late(int frame) { return frame >= k_first && k_late_frames[frame - k_first]; }

// Compares all fields that a substitute may change.
void expect_equal(const Estimates& found, const Estimates& expected) {
  EXPECT_EQ(found.verdict.stamp.sequence, expected.verdict.stamp.sequence);
  EXPECT_EQ(found.verdict.reason, expected.verdict.reason);
  ASSERT_EQ(found.tool_count, expected.tool_count);
  if (expected.tool_count == 0) return;
  EXPECT_EQ(found.tips[0].arm_m, expected.tips[0].arm_m);
  const Track& a = found.tracks[0];
  const Track& b = expected.tracks[0];
  EXPECT_EQ(a.alive, b.alive);
  EXPECT_EQ(a.measured_now, b.measured_now);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.newest.time, b.newest.time);
  EXPECT_EQ(a.newest.pose.translation, b.newest.pose.translation);
  EXPECT_EQ(a.T_camera_tool.translation, b.T_camera_tool.translation);
  EXPECT_EQ(a.motion.velocity_m_s, b.motion.velocity_m_s);
}

class FrameGroupOverruns : public testing::TestWithParam<OverrunPolicy> {
 protected:
  FrameGroupOverruns() : cell_(short_cell(1.0)) {
    cell_.overrun.frame = GetParam();
    const sim::Simulator simulator(scenario_of(cell_));
    for (int i = 0; i < k_first + k_checked; ++i) {
      simulator.render(i, frames_.emplace_back());
      frames_.back().head.valid = i != k_without_head;
    }
    watched_.live = false;
    watched_.watch = {true, cell_.deadlines.frame, GetParam(), {}};
    for (int i = k_first; i < k_first + k_checked; ++i) {
      if (!is_late(i)) continue;
      const std::uint64_t at = frames_[static_cast<std::size_t>(i)].sequence;
      watched_.injections.push_back({"", 1, false, at, cell_.deadlines.frame + Duration{1}});
    }
  }

  // Bit i of `taken`: the reader takes the newest version after judged frame i.
  void run(unsigned taken) const {
    SCOPED_TRACE("taken " + std::to_string(taken));
    GroupRunner<Tracker> runner(watched_);
    graph::TripleBuffer<ToolSet> tools;
    tools.write_slot() = cell_.tools;
    tools.publish(1, 0);
    const auto group = std::make_unique<FrameGroup>(
        cell_, tools, [] { return Time{}; }, runner, nullptr);
    const auto in_time = std::make_unique<Estimates>(), expected = std::make_unique<Estimates>(),
               held = std::make_unique<Estimates>();
    *held = group->estimates().value();
    for (int i = 0; i < k_first + k_checked; ++i) {
      SCOPED_TRACE("frame " + std::to_string(i));
      const sim::SimFrame& frame = frames_[static_cast<std::size_t>(i)];
      ArrivedFrame arrived;
      arrived.frame = frame.view();
      arrived.head = frame.head;
      group->process(arrived);
      if (i == k_first) {
        ASSERT_TRUE(group->newest().tracks[0].measured_now);
      }
      bool published = true;
      if (is_late(i)) {
        const OverrunFrame late{overrun_stamp(arrived.frame), arrived.head, cell_.lost_after};
        published = substitute(GetParam(), late, *in_time, *expected);
        EXPECT_EQ(group->tracker(), nullptr);
      } else {
        *in_time = *expected = group->newest();
        expect_equal(*in_time, group->tracker()->output<Estimates>());
      }
      if (published) expect_equal(group->newest(), *expected);
      expect_equal(group->estimates().value(), *held);  // the version being read is not overwritten
      if (i < k_first || (taken >> (i - k_first) & 1u) == 0) continue;
      const bool is_new = group->estimates().sample();
      EXPECT_TRUE(is_new || !published);
      *held = group->estimates().value();
      if (published) expect_equal(*held, *expected);
    }
  }

  Cell cell_;
  std::vector<sim::SimFrame> frames_;
  RunnerSettings<Tracker> watched_;
};

TEST_P(FrameGroupOverruns, RestOnWhatWasInTimeWheneverTheReaderTakesIt) {
  const auto step = static_cast<unsigned>(test::repetitions(1, 3));
  for (unsigned taken = 0; taken < 1u << k_checked; taken += step) run(taken);
}

INSTANTIATE_TEST_SUITE_P(ByEvery, FrameGroupOverruns,
                         testing::Values(OverrunPolicy::skip_output, OverrunPolicy::hold_last,
                                         OverrunPolicy::predict, OverrunPolicy::stop_safe),
                         [](const auto& policy) { return std::string(name_of(policy.param)); });

}  // namespace
}  // namespace glint
