#include "platform/budget/board_file.hpp"

#include <gtest/gtest.h>

#include "platform/budget/expected_board.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/budget/toy_graph.hpp"

namespace glint {
namespace {

BoardExpectation toy_expectation() {
  BoardExpectation expected;
  expected.build = "x86_64 GNU 12.2.0 -O3";
  expected.graphs = {{"Chain", "0x0000000000000001"}};
  for (const KernelLoops& kernel : kernels_of<toy::Chain>) expected.kernels.push_back(kernel);
  return expected;
}

const std::string k_toy = R"(name = "toy"
build = "x86_64 GNU 12.2.0 -O3"
counter = "instructions"
ns_per_instruction = 2
[graphs]
Chain = "0x0000000000000001"
[provenance]
machine = "a bench"
inputs = 10000
margin_percent = 5
[system]
wake_up_ns = 40000
[kernels.FindSpots]
call = 10.5
pixels = 0.25
[kernels.FitSpots]
call = 20
tools = 1.1
blobs = 3
)";

Board parsed(const std::string& text, BoardUse use = BoardUse::run_here) {
  return parse_board(text, "toy.toml", toy_expectation(), use);
}

std::string with(std::string text, const std::string& old, const std::string& now) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), now);
}

std::string error_message_of(const std::string& text, BoardUse use = BoardUse::run_here) {
  try {
    (void)parsed(text, use);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BoardFile, PricesEachLoopInPicosecondsRoundedUp) {
  const Board board = parsed(k_toy);
  const CostTable table = board.table();
  EXPECT_EQ(table.board, "toy");
  ASSERT_NE(table.find("FitSpots"), nullptr);
  EXPECT_EQ(table.find("FitSpots")->loops[1], "tools");
  EXPECT_EQ(table.find("FindSpots")->cost_ps[0], 21'000);
  EXPECT_EQ(table.find("FindSpots")->cost_ps[1], 500);
  EXPECT_EQ(table.find("FitSpots")->cost_ps[1], 2'200);
  EXPECT_EQ(board.system.wake_up_ns, 40'000);
  EXPECT_EQ(board.sha256.size(), 64u);
}

TEST(BoardFile, IsNamedByEveryByteOfItsText) {
  EXPECT_NE(parsed(k_toy).sha256, parsed(k_toy + "# a remark\n").sha256);
}

TEST(BoardFile, ReadsBackWhatItWrites) {
  Board board = parsed(k_toy);
  board.provenance.machine = "a \"bench\" \\ desk";
  const Board again = parsed(board_text(board));
  EXPECT_EQ(again.provenance.machine, board.provenance.machine);
  EXPECT_EQ(again.provenance.inputs, 10000);
  EXPECT_EQ(again.system.wake_up_ns, 40'000);
  ASSERT_EQ(again.costs.size(), board.costs.size());
  for (std::size_t i = 0; i < board.costs.size(); ++i) {
    EXPECT_EQ(again.costs[i].cost_ps, board.costs[i].cost_ps);
  }
  EXPECT_EQ(board_text(again), board_text(board));
}

TEST(BoardFile, OfAnotherArchitectureServesForAnalysisOnly) {
  const std::string arm = with(k_toy, "x86_64 GNU", "aarch64 GNU");
  EXPECT_EQ(error_message_of(arm, BoardUse::analyse), "accepted");
  EXPECT_NE(error_message_of(arm, BoardUse::run_here).find("toy.toml:2: build is \"aarch64"),
            std::string::npos);
}

struct InvalidBoardFile {
  const char* old;
  const char* now;
  const char* expected;
};

TEST(BoardFile, RefusesWhatItCannotVouchForByLineFindingAndExpectation) {
  const InvalidBoardFile cases[] = {
      {"name = \"toy\"", "", "toy.toml:1: name is missing; expected a text"},
      {"GNU 12.2.0", "Clang 14.0.6", "toy.toml:2: build is \"x86_64 Clang 14.0.6 -O3\"; expected"},
      {"12.2.0 -O3", "12.2.0 -O1", "toy.toml:2: build is \"x86_64 GNU 12.2.0 -O1\"; expected"},
      {"\"instructions\"", "\"cycles\"", "toy.toml:3: counter is \"cycles\"; expected one of"},
      {"ns_per_instruction = 2", "ns_per_instruction = -2", "toy.toml:4: ns_per_instruction is -2"},
      {"0x0000000000000001", "0x0000000000000002",
       "toy.toml:6: graphs.Chain is \"0x0000000000000002\"; expected \"0x0000000000000001\""},
      {"Chain = \"0x0000000000000001\"", "", "graphs.Chain is missing"},
      {"Chain =", "Other =", "graphs.Chain is missing"},
      {"wake_up_ns = 40000", "wake_up_ns = -1", "toy.toml:12: system.wake_up_ns is -1; expected"},
      {"wake_up_ns", "wakeup_ns",
       "toy.toml:12: unknown key system.wakeup_ns; did you mean wake_up_ns?; expected one of"},
      {"call = 10.5", "call = -10.5",
       "toy.toml:14: kernels.FindSpots.call is -10.5; expected a number from 0"},
      {"call = 10.5", "call = nan", "toy.toml:14: kernels.FindSpots.call is nan; expected"},
      {"call = 10.5", "call = \"ten\"", "toy.toml:14: kernels.FindSpots.call is \"ten\""},
      {"pixels = 0.25", "",
       "toy.toml:13: kernels.FindSpots.pixels is missing; expected costs of "
       "call, pixels"},
      {"pixels = 0.25", "pixels = 0.25\nruns = 1",
       "toy.toml:16: unknown key kernels.FindSpots.runs; expected one of call, pixels"},
      {"[kernels.FitSpots]", "[kernels.FitSpot]",
       "kernels.FitSpots is missing; expected its costs of call, tools, blobs"},
      {"[system]", "[kernels.Gone]\ncall = 1\n[system]",
       "toy.toml:11: unknown key kernels.Gone; expected one of FindSpots, FitSpots"},
      {"machine = \"a bench\"", "", "provenance.machine is missing"},
      {"[graphs]", "[graphs", "toy.toml:5: "},
  };
  for (const InvalidBoardFile& bad : cases) {
    const std::string found = error_message_of(with(k_toy, bad.old, bad.now));
    EXPECT_NE(found.find(bad.expected), std::string::npos) << found << "\n  for " << bad.now;
    EXPECT_EQ(found.find('\n'), std::string::npos) << found;
  }
}

TEST(BoardFile, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  try {
    (void)load_board("no-such-board", toy_expectation(), BoardUse::analyse);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"no-such-board\" is not built in; expected a file"),
              std::string::npos)
        << error.what();
  }
}

// The toy kernel's second graph: not every cell runs it.
BoardExpectation with_an_optional_graph() {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  BoardExpectation expected = toy_expectation();
  expected.optional.push_back({{"Spare", "0x0000000000000003"}, {{"Slice", k_loops}}});
  return expected;
}

TEST(BoardFile, MayLeaveOutAGraphThatNotEveryCellRunsWithItsCosts) {
  const auto found = [](const std::string& text) -> std::string {
    try {
      const Board board =
          parse_board(text, "toy.toml", with_an_optional_graph(), BoardUse::run_here);
      EXPECT_EQ(board_text(parse_board(board_text(board), "again.toml", with_an_optional_graph(),
                                       BoardUse::run_here)),
                board_text(board));
      return std::to_string(board.graphs.size()) + " graphs, " +
             std::to_string(board.costs.size()) + " kernels";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string graph = "[graphs]\nSpare = \"0x0000000000000003\"\n";
  const std::string slice = "[kernels.Slice]\ncall = 1\nsteps = 2\n";
  EXPECT_EQ(found(k_toy), "1 graphs, 2 kernels");
  EXPECT_EQ(found(with(k_toy, "[graphs]\n", graph) + slice), "2 graphs, 3 kernels");
  EXPECT_EQ(found(with(k_toy, "[graphs]\n", graph)),
            "toy.toml:14: kernels.Slice is missing; expected its costs of call, steps");
  EXPECT_EQ(found(k_toy + slice).find("toy.toml:20: unknown key kernels.Slice; expected one of"),
            0u)
      << found(k_toy + slice);
  EXPECT_EQ(found(with(with(k_toy, "[graphs]\n", graph), "03\"", "04\"") + slice)
                .find("toy.toml:6: graphs.Spare is \"0x0000000000000004\"; expected"),
            0u);
  EXPECT_EQ(found(with(with(k_toy, "[graphs]\n", graph), "\"0x0000000000000003\"", "\"\"") + slice),
            "toy.toml:5: graphs.Spare is missing; expected a text in quotes");
}

TEST(BoardFile, ExpectsEveryNodeOfBothGroupsAndThisBuild) {
  const BoardExpectation expected = expected_board();
  EXPECT_EQ(expected.graphs.size(), 2u);
  EXPECT_GE(expected.kernels.size(), 13u);
  ASSERT_EQ(expected.optional.size(), 1u);
  EXPECT_EQ(expected.optional[0].graph.name, "Background");
  ASSERT_EQ(expected.optional[0].kernels.size(), 2u);
  EXPECT_EQ(expected.optional[0].kernels[0].kernel, "ExtendMap");
  EXPECT_EQ(expected.optional[0].kernels[1].kernel, "FollowRobot");
  EXPECT_NE(expected.build.find("-ffp-contract=off"), std::string::npos) << expected.build;
  EXPECT_NE(expected.build.find("-DEIGEN_DONT_VECTORIZE"), std::string::npos) << expected.build;
}

}  // namespace
}  // namespace glint
