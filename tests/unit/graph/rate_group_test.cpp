#include <gtest/gtest.h>

#include "small_graph.hpp"

namespace glint::test::rate_group_test {
namespace {

struct Fixture {
  SmallGraph graph;
  TripleBuffer<Scale> scales;
  RateGroup<SmallGraph> group{graph, 3};
  Fixture() {
    graph.latest<Scale>().bind(scales);
    graph.input<Row>().numbers = {1, 0, 0, 0, 0, 0, 0, 0};
  }
  void publish(int factor, std::uint64_t version) {
    scales.write_slot().factor = factor;
    scales.publish(version, 1000 * static_cast<std::int64_t>(version));
  }
};

TEST(RateGroup, NotesTheReleaseAndTheVersionsItSampled) {
  Fixture f;
  f.publish(5, 1);
  f.publish(6, 2);
  const ReleaseInputs& choice = f.group.release(4'000'000);
  EXPECT_EQ(choice.group, 3u);
  EXPECT_EQ(choice.activation, 1u);
  EXPECT_EQ(choice.nominal_ns, 4'000'000);
  ASSERT_EQ(choice.version_count, 1);
  EXPECT_EQ(choice.versions[0], 2u);
  EXPECT_EQ(f.graph.latest<Scale>().time_ns(), 2000);
}

TEST(RateGroup, ShowsAllNodesOneVersionUntilTheNextRelease) {
  Fixture f;
  f.publish(5, 1);
  f.group.release(0);
  f.publish(6, 2);
  f.group.activate();
  EXPECT_EQ(f.graph.output<Total>().value, 5);
  f.group.release(1);
  f.group.activate();
  EXPECT_EQ(f.graph.output<Total>().value, 11);
}

TEST(RateGroup, StartsWithAnEmptyValueOfVersionZero) {
  Fixture f;
  EXPECT_EQ(f.group.release(0).versions[0], 0u);
  EXPECT_EQ(f.graph.latest<Scale>().value().factor, 1);
}

TEST(RateGroup, ReplaysTheRecordedVersionsAlthoughNewerOnesAreThere) {
  Fixture live;
  std::array<ReleaseInputs, 3> recorded;
  std::array<int, 3> totals{};
  for (int i = 0; i < 3; ++i) {
    if (i != 1) live.publish(i + 1, static_cast<std::uint64_t>(i) + 1);
    recorded[i] = live.group.release(i);
    live.group.activate();
    totals[i] = live.graph.output<Total>().value;
  }
  Fixture replay;
  for (int i = 0; i < 3; ++i) {
    if (i == 0) replay.publish(1, 1);
    if (i == 1) replay.publish(3, 3);  // too early: release 1 read version 1 and must read it again
    EXPECT_TRUE(replay.group.release_as(recorded[i])) << i;
    replay.group.activate();
    EXPECT_EQ(replay.graph.output<Total>().value, totals[i]) << i;
  }
}

TEST(RateGroup, SaysWhenARecordedVersionWasNotPublished) {
  Fixture f;
  ReleaseInputs recorded = f.group.release(0);
  recorded.activation = 2;
  recorded.versions[0] = 7;
  f.publish(5, 6);
  EXPECT_FALSE(f.group.release_as(recorded));
  f.publish(5, 7);
  EXPECT_TRUE(f.group.release_as(recorded));
}

struct Offset {
  int value = 0;
};
struct AddBoth {
  void operator()(const Row&, const Latest<Scale>& scale, const Latest<Offset>& offset,
                  Sum& sum) const noexcept {
    sum.value = scale.value().factor + offset.value().value;
  }
};
using TwoRates = Graph<Inputs<Latest<Scale>, Row, Latest<Offset>>, Outputs<Sum>, AddBoth>;

// Each of two inputs has its own version, in the order of Inputs<>.
TEST(RateGroup, NotesAndReplaysTheVersionOfEachOfItsInputs) {
  TripleBuffer<Scale> scales;
  TripleBuffer<Offset> offsets;
  TwoRates graph;
  graph.latest<Scale>().bind(scales);
  graph.latest<Offset>().bind(offsets);
  RateGroup<TwoRates> group(graph, 5);
  const auto publish = [](auto& buffer, std::uint64_t version) { buffer.publish(version, 0); };
  publish(scales, 11);
  publish(offsets, 21);
  const ReleaseInputs first = group.release(1'000);
  EXPECT_EQ(first.version_count, 2);
  EXPECT_EQ(first.versions[0], 11U);
  EXPECT_EQ(first.versions[1], 21U);
  EXPECT_EQ(group.choice(), first);
  publish(offsets, 22);
  const ReleaseInputs second = group.release(2'000);
  EXPECT_EQ(second.activation, 2U);
  EXPECT_EQ(second.nominal_ns, 2'000);
  EXPECT_EQ(second.versions[0], 11U) << "nothing newer";
  EXPECT_EQ(second.versions[1], 22U);
  // Both inputs have a newer version. A replay changes only the input with another version.
  ReleaseInputs recorded = second;
  recorded.activation = 9;
  recorded.nominal_ns = 9'000;
  recorded.versions[1] = 23;
  publish(scales, 12);
  publish(offsets, 23);
  EXPECT_TRUE(group.release_as(recorded));
  EXPECT_EQ(group.choice(), recorded);
  EXPECT_EQ(group.release(10'000).activation, 10U) << "counts on from what was replayed";
}

TEST(RateGroup, ReplaysNoChoiceOfAnotherGroupOrOfFewerInputs) {
  for (const bool fewer : {false, true}) {
    Fixture f;
    ReleaseInputs recorded = f.group.release(0);
    if (fewer) recorded.version_count = 0;
    if (!fewer) ++recorded.group;
    EXPECT_FALSE(f.group.release_as(recorded)) << fewer;
  }
}

}  // namespace
}  // namespace glint::test::rate_group_test
