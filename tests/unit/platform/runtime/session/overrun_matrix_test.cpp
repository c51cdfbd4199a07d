// Fault injection: every overrun policy at every node, detected ahead by a bound or at the
// deadline. Each has its declared effect exactly once, in the recording and on the bus, and replays
// identically.
//
// The test uses no clock: only the injected delays advance time, so each decision is exact to the
// nanosecond. After each delay that exceeds the limit, the next activation has a delay that just
// fits.
#include <cstdio>
#include <tuple>
#include <vector>

#include "platform/runtime/session/replay.hpp"
#include "tests/unit/platform/runtime/session/overrun_log.hpp"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint {
namespace {

using graph::OverrunDecision;
using graph::OverrunKind;
using graph::OverrunPolicy;

constexpr std::uint32_t k_first_frame = 8, k_frame_step = 2;
constexpr std::uint32_t k_first_tick = 150, k_tick_step = 5;

// A different bound for each node.
template <class G>
std::vector<std::int64_t> node_bounds() {
  std::vector<std::int64_t> bounds;
  for (int node = 0; node < G::node_count; ++node) bounds.push_back(100'000 + 1'000 * node);
  return bounds;
}

// One row of the matrix: the expected decision after a delay at the end of one node.
struct Row {
  std::uint32_t at = 0;      // sequence number of the frame, or tick number
  Duration longest_in_time;  // one nanosecond more is an overrun
  OverrunDecision decision;
};

template <class G>
std::vector<Row> rows(Duration deadline, OverrunPolicy policy, bool bounded, std::uint32_t first,
                      std::uint32_t step) {
  const std::vector<std::int64_t> bounds = node_bounds<G>();
  std::vector<Row> all(bounds.size());
  Duration remaining;  // 0 after the last node: there only the deadline itself can pass
  for (std::size_t node = bounds.size(); node-- > 0;) {
    const bool ahead = bounded && remaining.nanoseconds > 0;
    all[node] = {first + step * static_cast<std::uint32_t>(node),
                 ahead ? deadline - remaining : deadline,
                 {ahead ? OverrunKind::will_miss : OverrunKind::missed, policy,
                  static_cast<std::uint8_t>(node)}};
    remaining = remaining + Duration{bounds[node]};
  }
  return all;
}

void inject(const std::vector<Row>& rows, bool in_tick, std::vector<Injection>& injections) {
  for (const Row& row : rows) {
    const int node = row.decision.after_node;
    injections.push_back({"", node, in_tick, row.at, row.longest_in_time + Duration{1}});
    injections.push_back({"", node, in_tick, row.at + 1, row.longest_in_time});
  }
}

std::string emergency(std::uint8_t group, const OverrunDecision& decision) {
  char text[32];
  const auto reason = static_cast<unsigned>(reason_of(decision.policy));
  std::snprintf(text, sizeof text, "%02XFF81%02X%02X%02X00%02X", reason, unsigned{group},
                static_cast<unsigned>(decision.kind), reason, unsigned{decision.after_node});
  return text;
}

using Parameters = std::tuple<OverrunPolicy, bool, const char*>;

class OverrunMatrix : public testing::TestWithParam<Parameters> {
 protected:
  OverrunMatrix() {
    cell_ = short_cell(1.35, std::get<2>(GetParam()));
    cell_.overrun.frame = cell_.overrun.tick = policy_;
    frame_rows_ =
        rows<Tracker>(cell_.deadlines.frame, policy_, bounded_, k_first_frame, k_frame_step);
    tick_rows_ = rows<Output>(cell_.deadlines.tick, policy_, bounded_, k_first_tick, k_tick_step);
    options_.out = folder_.path();
    inject(frame_rows_, false, options_.injections);
    inject(tick_rows_, true, options_.injections);
    if (!bounded_) return;
    options_.plan = schedule_by_rule(cell_);
    options_.plan.planned = true;
    options_.plan.frame.bounds_ns = options_.plan.frame.remaining_ns = node_bounds<Tracker>();
    options_.plan.tick.bounds_ns = options_.plan.tick.remaining_ns = node_bounds<Output>();
  }

  void expect_decisions(const SessionResult& run, const OverrunLog& log) const;
  void expect_tick_outputs(const OverrunLog& log) const;
  void expect_frame_outputs(const OverrunLog& log) const;
  static void expect_identical_replay(const SessionResult& run);

  OverrunPolicy policy_ = std::get<0>(GetParam());
  bool bounded_ = std::get<1>(GetParam());
  Cell cell_;
  TemporaryFolder folder_;
  SessionOptions options_;
  std::vector<Row> frame_rows_, tick_rows_;
};

void expect_counts(const OverrunCounts& counts, const std::vector<Row>& rows, bool bounded) {
  EXPECT_EQ(counts.will_miss, bounded ? rows.size() - 1 : 0);
  EXPECT_EQ(counts.missed, bounded ? 1 : rows.size());
  EXPECT_EQ(counts.by_policy[static_cast<std::size_t>(rows[0].decision.policy)], rows.size());
}

// Each decision once, at its node, in the recording and on the bus, and no other.
void OverrunMatrix::expect_decisions(const SessionResult& run, const OverrunLog& log) const {
  std::map<std::uint32_t, OverrunDecision> frames, ticks;
  std::map<std::string, int> emergencies;
  for (const Row& row : frame_rows_) {
    frames[row.at] = row.decision;
    emergencies[emergency(k_frame_group, row.decision)] = 1;
  }
  for (const Row& row : tick_rows_) {
    ticks[row.at] = row.decision;
    emergencies[emergency(k_tick_group, row.decision)] = 1;
  }
  EXPECT_EQ(log.frames, frames);
  EXPECT_EQ(log.ticks, ticks);
  EXPECT_EQ(log.emergencies, emergencies);
  expect_counts(run.frame_overruns, frame_rows_, bounded_);
  expect_counts(run.tick_overruns, tick_rows_, bounded_);
}

// Checks a pose that the overrun policy substituted for a measured one.
void expect_substitute(OverrunPolicy policy, const PoseSample& sample) {
  EXPECT_EQ(sample.reason, reason_of(policy));
  EXPECT_EQ(sample.state,
            policy == OverrunPolicy::stop_safe ? TrackState::lost : TrackState::predicted);
}

// Checks the motion from the previous tick to this one.
void expect_motion(OverrunPolicy policy, const PoseSample& before, const PoseSample& sample,
                   double tolerance_m) {
  const Vector3 moved = sample.pose.translation - before.pose.translation;
  if (policy == OverrunPolicy::hold_last) {
    EXPECT_EQ(moved.norm(), 0);
  }
  if (policy == OverrunPolicy::predict) {
    // A hand that was detected as static stays at its pose.
    EXPECT_EQ(moved.norm() > 0, before.velocity_m_s.norm() > 0);
    EXPECT_LT((moved - before.velocity_m_s * 0.004).norm(), tolerance_m);
  }
}

void OverrunMatrix::expect_tick_outputs(const OverrunLog& log) const {
  for (const Row& row : tick_rows_) {
    SCOPED_TRACE("tick " + std::to_string(row.at));
    ASSERT_EQ(log.outputs.count(row.at), policy_ == OverrunPolicy::skip_output ? 0u : 1u);
    EXPECT_EQ(log.ticks.count(row.at + 1), 0u);
    ASSERT_EQ(log.outputs.count(row.at + 1), 1u) << "the next tick is in time";
    if (policy_ == OverrunPolicy::skip_output) continue;
    expect_substitute(policy_, log.outputs.at(row.at));
    expect_motion(policy_, log.outputs.at(row.at - 1), log.outputs.at(row.at), 1e-9);
  }
  for (const auto& [tick, version] : log.versions) {
    SCOPED_TRACE("tick " + std::to_string(tick));
    const auto output = log.outputs.find(tick);
    const auto bus = log.bus.find(tick);
    ASSERT_EQ(bus != log.bus.end(), output != log.outputs.end()) << "both or none";
    if (bus == log.bus.end()) continue;
    EXPECT_EQ(bus->second.frames, k_can_frames_per_pose_max);
    EXPECT_EQ(bus->second.state, output->second.state);
  }
}

void OverrunMatrix::expect_frame_outputs(const OverrunLog& log) const {
  std::map<std::uint64_t, int> read;  // number of ticks that read each late frame's estimates
  int moving = 0;                     // checked poses of a tool that was not static
  for (const Row& row : frame_rows_) read[log.activations.at(row.at)] = 0;
  for (const auto& [tick, version] : log.versions) {
    SCOPED_TRACE("tick " + std::to_string(tick));
    const auto output = log.outputs.find(tick);
    const bool late_tick = log.ticks.count(tick) != 0;
    const auto late_frame = read.find(version);
    if (late_tick || output == log.outputs.end()) continue;
    const PoseSample& sample = output->second;
    ASSERT_EQ(is_overrun(sample.reason), late_frame != read.end());
    if (late_frame == read.end()) continue;
    expect_substitute(policy_, sample);
    // The tip rotates about the tool's origin, so its velocity is valid only at one instant.
    if (++late_frame->second > 1 && log.ticks.count(tick - 1) == 0) {
      expect_motion(policy_, log.outputs.at(tick - 1), sample, 2e-5);
      moving += log.outputs.at(tick - 1).velocity_m_s.norm() > 0.001 ? 1 : 0;
    }
  }
  if (policy_ == OverrunPolicy::predict) {
    EXPECT_GT(moving, 10);
  }
  for (const auto& [activation, ticks] : read) {
    if (policy_ == OverrunPolicy::skip_output) {
      EXPECT_EQ(ticks, 0) << "activation " << activation << " published nothing";
    } else {
      EXPECT_GE(ticks, 4) << "of some five that follow activation " << activation;
    }
  }
}

void OverrunMatrix::expect_identical_replay(const SessionResult& run) {
  for (int workers = test::repetitions(1, 2); workers <= 2; ++workers) {
    const ReplayResult result = expect_same_bytes(run.recording_file, run, workers);
    EXPECT_EQ(result.overruns, Tracker::node_count + Output::node_count);
  }
}

TEST_P(OverrunMatrix, HasItsDeclaredEffectOnceAtEveryNodeAndReplaysToTheSameBytes) {
  const SessionResult run = run_simulated(cell_, options_);
  ASSERT_TRUE(run.recording.complete());
  const OverrunLog log = overrun_log(run.recording_file, folder_.path() + "/can.log");
  expect_decisions(run, log);
  expect_tick_outputs(log);
  expect_frame_outputs(log);
  expect_identical_replay(run);
}

INSTANTIATE_TEST_SUITE_P(
    ByEvery, OverrunMatrix,
    testing::Combine(testing::Values(OverrunPolicy::skip_output, OverrunPolicy::hold_last,
                                     OverrunPolicy::predict, OverrunPolicy::stop_safe),
                     testing::Bool(), testing::Values("full", "roi", "blobs")),
    [](const auto& row) {
      return std::string(name_of(std::get<0>(row.param))) +
             (std::get<1>(row.param) ? "_noticed_ahead_" : "_noticed_late_") +
             std::get<2>(row.param);
    });

}  // namespace
}  // namespace glint
