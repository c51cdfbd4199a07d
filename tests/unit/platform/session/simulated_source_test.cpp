#include "platform/session/simulated_source.hpp"

#include <cstdint>

#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

// A clock far ahead of every frame: one that is not rendered yet is late.
int late_of(SimulatedSource& source) {
  source.start([](Time) {}, [] { return Time{} + milliseconds(1'000'000); });
  ArrivedFrame arrived;
  std::uint32_t next = 0;
  while (source.wait(arrived)) {
    EXPECT_EQ(arrived.frame.sequence, next++) << "in order, by two renderers";
    source.give_back(arrived);
  }
  return source.late_renders();
}

TEST(SimulatedSource, RendersAShortRunBeforeItStarts) {
  const sim::Simulator simulator(scenario_of(short_cell(2)));
  SimulatedSource source(simulator, {.live = true, .frame_time = {}});
  source.fill();
  EXPECT_DOUBLE_EQ(source.delivered_part(), 0);
  EXPECT_EQ(late_of(source), 0);
  EXPECT_DOUBLE_EQ(source.delivered_part(), 1);
}

TEST(SimulatedSource, StopsFillingWhenAsked) {
  const sim::Simulator simulator(scenario_of(short_cell(4)));
  SimulatedSource source(simulator, {.live = true, .frame_time = {}});
  int asked = 0;
  source.fill([&asked](int, int wanted) {
    EXPECT_GT(wanted, 0);
    ++asked;
    return false;
  });
  EXPECT_LE(asked, 1);
}

TEST(SimulatedSource, IsLateFromWhenItsFirstLateFrameWasDue) {
  const sim::Simulator simulator(scenario_of(short_cell(1)));
  SimulatedSource source(simulator, {.live = false, .frame_time = milliseconds(30)});
  source.start({}, [] { return Time{}; });
  const Time due = simulator.timing(0).arrival;
  ArrivedFrame arrived;
  EXPECT_FALSE(source.late(due));
  ASSERT_TRUE(source.wait(arrived));
  EXPECT_EQ(arrived.frame.arrival, due + milliseconds(30));
  EXPECT_FALSE(source.late(due - microseconds(1)));
  EXPECT_TRUE(source.late(due));
  source.give_back(arrived);
  ASSERT_TRUE(source.wait(arrived));
  EXPECT_EQ(arrived.frame.arrival, due + milliseconds(60)) << "one frame after the other";
  EXPECT_TRUE(source.late(due));
  while (source.wait(arrived)) source.give_back(arrived);
  EXPECT_FALSE(source.late(due + milliseconds(100'000))) << "nothing is due any more";
}

}  // namespace
}  // namespace glint
