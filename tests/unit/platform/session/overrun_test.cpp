// Fault injection: every policy at every node has its declared effect once, in the recording and on
// the bus, and the recording's replay decides the same.
#include <fstream>
#include <map>
#include <sstream>

#include "graph/describe.hpp"
#include "kernels/wire/output_record.hpp"
#include "nodes/overrun_effects.hpp"
#include "platform/budget/export/trace_file.hpp"
#include "platform/input_error.hpp"
#include "platform/session/choices.hpp"
#include "platform/session/injection_text.hpp"
#include "platform/session/replay.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

using graph::OverrunDecision;
using graph::OverrunKind;
using graph::OverrunPolicy;

constexpr int k_first_frame = 8;
constexpr std::uint32_t k_first_tick = 150;

// One delay at every node of both graphs, each in an activation of its own, two apart.
std::vector<Injection> one_at_every_node(Duration delay) {
  std::vector<Injection> all;
  for (int node = 0; node < Tracker::node_count; ++node) {
    all.push_back({"", node, false, static_cast<std::uint32_t>(k_first_frame + 2 * node), delay});
  }
  for (int node = 0; node < Output::node_count; ++node) {
    all.push_back({"", node, true, k_first_tick + 5 * static_cast<std::uint32_t>(node), delay});
  }
  return all;
}

struct Log {
  std::map<std::uint32_t, OverrunDecision> frames, ticks;  // by sequence and by tick number
  std::map<std::uint32_t, PoseSample> outputs;             // of the first tool, by tick number
};

Log log_of(const std::string& recording) {
  Log log;
  RecordingReader reader(recording, {});
  ChoiceRecord frame_choice;
  while (const auto message = reader.next()) {
    if (const auto* choice = std::get_if<ChoiceRecord>(&*message)) {
      if (choice->group == k_frame_group) frame_choice = *choice;
      if (choice->group == k_tick_group && choice->overrun.happened()) {
        log.ticks[static_cast<std::uint32_t>(choice->nominal.nanoseconds / 4'000'000)] =
            choice->overrun;
      }
    } else if (const auto* frame = std::get_if<FrameMessage>(&*message)) {
      if (frame_choice.overrun.happened()) log.frames[frame->sequence] = frame_choice.overrun;
    } else if (const auto* output = std::get_if<OutputMessage>(&*message)) {
      const auto sample =
          decode(std::span<const std::uint8_t, k_output_record_bytes>(output->record.data(), 448));
      EXPECT_TRUE(sample);
      log.outputs[sample.value.tick_number] = sample.value;
    }
  }
  return log;
}

// How often each emergency of an overrun stands in the CAN log, by its eight bytes.
std::map<std::string, int> overruns_on_the_bus(const std::string& folder) {
  std::map<std::string, int> found;
  std::ifstream log(folder + "/can.log");
  for (std::string line; std::getline(log, line);) {
    const std::size_t at = line.find("0A0#");
    if (at == std::string::npos) continue;
    const std::string bytes = line.substr(at + 4, 16);
    const int code = std::stoi(bytes.substr(0, 2), nullptr, 16);
    // Kind 3 is none: a tool that stop_safe declares lost has an emergency of its own, state 3.
    if (bytes.substr(2, 2) == "FF" && bytes.substr(8, 2) != "03" &&
        code >= static_cast<int>(Reason::overrun_skipped)) {
      ++found[bytes];
    }
  }
  return found;
}

std::string emergency(OverrunPolicy policy, int group, OverrunKind kind, int node) {
  char text[32];
  const auto reason = static_cast<unsigned>(reason_of(policy));
  std::snprintf(text, sizeof text, "%02XFF81%02X%02X%02X00%02X", reason,
                static_cast<unsigned>(group), static_cast<unsigned>(kind), reason,
                static_cast<unsigned>(node));
  return text;
}

class Overrun : public testing::TestWithParam<OverrunPolicy> {
 protected:
  Overrun() {
    cell_ = short_cell(1.4);
    cell_.overrun.frame = cell_.overrun.tick = GetParam();
    options_.out = folder_.path();
    options_.injections = one_at_every_node(milliseconds(30));
  }
  Cell cell_;
  TemporaryFolder folder_;
  SessionOptions options_;
};

TEST_P(Overrun, IsDecidedOnceAtEveryNodeInTheRecordingAndOnTheBus) {
  const SessionResult run = run_session(cell_, options_);
  ASSERT_TRUE(run.recording.complete());
  const Log log = log_of(run.recording_file);
  auto bus = overruns_on_the_bus(folder_.path());
  for (int node = 0; node < Tracker::node_count; ++node) {
    const OverrunDecision expected{OverrunKind::missed, GetParam(),
                                   static_cast<std::uint8_t>(node)};
    const auto at = log.frames.find(static_cast<std::uint32_t>(k_first_frame + 2 * node));
    ASSERT_NE(at, log.frames.end()) << "node " << node;
    EXPECT_EQ(at->second, expected);
    EXPECT_EQ(bus[emergency(GetParam(), 0, OverrunKind::missed, node)], 1) << "node " << node;
  }
  for (int node = 0; node < Output::node_count; ++node) {
    const OverrunDecision expected{OverrunKind::missed, GetParam(),
                                   static_cast<std::uint8_t>(node)};
    const auto at = log.ticks.find(k_first_tick + 5 * static_cast<std::uint32_t>(node));
    ASSERT_NE(at, log.ticks.end()) << "node " << node;
    EXPECT_EQ(at->second, expected);
    EXPECT_EQ(bus[emergency(GetParam(), 1, OverrunKind::missed, node)], 1) << "node " << node;
  }
  EXPECT_EQ(log.frames.size(), static_cast<std::size_t>(Tracker::node_count));
  EXPECT_EQ(log.ticks.size(), static_cast<std::size_t>(Output::node_count));
  EXPECT_EQ(bus.size(), log.frames.size() + log.ticks.size());
  EXPECT_EQ(run.frame_overruns.missed, log.frames.size());
  EXPECT_EQ(run.tick_overruns.by_policy[static_cast<std::size_t>(GetParam())], log.ticks.size());
}

TEST_P(Overrun, HasItsDeclaredEffectOnWhatLeaves) {
  const SessionResult run = run_session(cell_, options_);
  const Log log = log_of(run.recording_file);
  for (int node = 0; node < Output::node_count; ++node) {
    const std::uint32_t tick = k_first_tick + 5 * static_cast<std::uint32_t>(node);
    const auto at = log.outputs.find(tick);
    if (GetParam() == OverrunPolicy::skip_output) {
      EXPECT_EQ(at, log.outputs.end()) << "nothing leaves at tick " << tick;
      continue;
    }
    ASSERT_NE(at, log.outputs.end());
    const PoseSample &sample = at->second, &before = log.outputs.at(tick - 1);
    EXPECT_EQ(sample.reason, reason_of(GetParam()));
    EXPECT_EQ(sample.state,
              GetParam() == OverrunPolicy::stop_safe ? TrackState::lost : TrackState::predicted);
    const double moved = (sample.pose.translation - before.pose.translation).norm();
    if (GetParam() == OverrunPolicy::hold_last) {
      EXPECT_EQ(moved, 0);
    }
    if (GetParam() == OverrunPolicy::predict) {
      EXPECT_NEAR(moved, before.velocity_m_s.norm() * 0.004, 1e-9);
    }
    EXPECT_EQ(log.outputs.at(tick + 1).reason == reason_of(GetParam()),
              is_overrun(log.outputs.at(tick + 1).reason))
        << "a frame's overrun, if any";
  }
  // Of the frame group: what the ticks after a late frame say of the tool.
  int substituted = 0;
  for (const auto& [tick, sample] : log.outputs) {
    if (log.ticks.count(tick) == 0 && is_overrun(sample.reason)) {
      EXPECT_EQ(sample.reason, reason_of(GetParam()));
      EXPECT_NE(sample.state, TrackState::measured);
      ++substituted;
    }
  }
  if (GetParam() == OverrunPolicy::skip_output) {
    EXPECT_EQ(substituted, 0);
  } else {
    EXPECT_GE(substituted, 4 * Tracker::node_count) << "some five ticks after each late frame";
  }
}

TEST_P(Overrun, ReplaysToTheSameBytesAtEveryLevelWithoutAClock) {
  for (const char* level : {"full", "roi", "blobs"}) {
    TemporaryFolder folder;
    cell_.record.level = level;
    options_.out = folder.path();
    const SessionResult run = run_session(cell_, options_);
    for (const int workers : {1, 2}) {
      ReplayOptions options;
      options.workers = workers;
      const ReplayResult result = replay(run.recording_file, options);
      EXPECT_TRUE(result.agrees())
          << level << ": " << result.mismatches << " differ, first " << result.first_mismatch;
      EXPECT_EQ(result.output_sha256, run.output_sha256);
      EXPECT_EQ(result.overruns, Tracker::node_count + Output::node_count);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ByEveryPolicy, Overrun,
                         testing::Values(OverrunPolicy::skip_output, OverrunPolicy::hold_last,
                                         OverrunPolicy::predict, OverrunPolicy::stop_safe),
                         [](const auto& policy) { return std::string(name_of(policy.param)); });

TEST(OverrunWatch, NoticesAheadOfTheDeadlineWhereTheBoundTellsIt) {
  TemporaryFolder folder;
  Cell cell = short_cell(0.5);
  SessionOptions options;
  options.out = folder.path();
  options.plan = plan_by_rule(cell);
  options.plan.planned = true;
  // 1 ms a node: after node 3 with 15 ms gone, the others no longer fit into 22.2 ms.
  options.plan.frame.bounds_ns.assign(Tracker::node_count, 1'000'000);
  options.plan.frame.remaining_ns.assign(Tracker::node_count, 0);
  options.injections = {injection_of("node=LocateRois,delay_us=15000,frame=9"),
                        injection_of("node=TrackTools,delay_us=15000,frame=12")};
  const SessionResult run = run_session(cell, options);
  const Log log = log_of(run.recording_file);
  ASSERT_EQ(log.frames.size(), 1u) << "after the last node nothing remains, and 15 ms are in time";
  EXPECT_EQ(log.frames.begin()->first, 9u);
  EXPECT_EQ(log.frames.begin()->second,
            (OverrunDecision{OverrunKind::will_miss, OverrunPolicy::predict, 3}));
  EXPECT_EQ(run.frame_overruns.will_miss, 1u);
  EXPECT_TRUE(replay(run.recording_file, {}).agrees());
}

TEST(OverrunWatch, DecidesNothingInARunWithoutAClockAndWithoutInjections) {
  TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(0.5), folder.path());
  EXPECT_EQ(run.frame_overruns.total() + run.tick_overruns.total(), 0u);
}

TEST(OverrunWatch, RefusesAnInjectionThatNamesNoNodeOfItsGroup) {
  const Injection copy = injection_of("node=RoiThreshold#1,delay_us=200,frame=512");
  EXPECT_EQ(copy.at, 512u);
  EXPECT_EQ(copy.delay, microseconds(200));
  EXPECT_EQ(graph::Description<Tracker>::nodes[static_cast<std::size_t>(copy.number)].copy, 1);
  EXPECT_TRUE(injection_of("node=PackCan,delay_us=1,tick=3").in_tick);
  EXPECT_THROW((void)injection_of("node=PackCan,delay_us=1,frame=3"), InputError);
  EXPECT_THROW((void)injection_of("node=FindBlobs,delay_us=-1,frame=3"), InputError);
  EXPECT_THROW((void)injection_of("node=FindBlobs,delay_us=1"), InputError);
  EXPECT_THROW((void)injection_of("node=FindBlobs,delay_us=1,frame=3,tick=4"), InputError);
}

TEST(OverrunTrace, OfARunInOrderStandsOnTheSessionsTime) {
  const TemporaryFolder folder;
  SessionOptions options;
  options.out = folder.path();
  options.trace = true;
  const SessionResult run = run_session(short_cell(0.5), options);
  const TraceFile trace = read_trace(folder.path() + "/trace.spans");
  EXPECT_EQ(trace.spans.size(), run.trace_spans);
  for (const TraceSpan& span : trace.spans) {
    EXPECT_GE(span.begin_ns, 0);
    EXPECT_GE(span.end_ns, span.begin_ns);
    EXPECT_LT(span.end_ns, 2'000'000'000) << "since the session's epoch";
  }
}

}  // namespace
}  // namespace glint
