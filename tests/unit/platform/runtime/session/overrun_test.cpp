// Overrun watch: no decision without a clock and injections; rejected injections; trace.
#include "graph/describe.hpp"
#include "platform/budget/export/trace_file.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/node_probe.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

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
  const SessionResult run = run_simulated(short_cell(0.5), options);
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
