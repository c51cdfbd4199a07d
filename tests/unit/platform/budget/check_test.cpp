#include "platform/budget/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "platform/budget/bus_frames.hpp"
#include "platform/budget/plan_file.hpp"
#include "platform/budget/slack_table.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"
#include "schedules/sensitivity.hpp"
#include "schedules/synthesis.hpp"
#include "tests/unit/platform/budget/flat_board.hpp"

namespace glint::check_test {
namespace {

struct Fixture {
  explicit Fixture(double ns_a_count = 0.2, int cores = 2) : board(uniform_costs(ns_a_count)) {
    TaskModel model = task_model_of(cell, board.table(), board.system, small_limits());
    model.cores = cores;
    plan = synthesize(model);
    plan.board_sha256 = board.sha256;
  }
  [[nodiscard]] CheckInput input() const { return {cell, board, plan, small_limits(), foreign}; }

  Cell cell = default_cell();
  Board board;
  Plan plan;
  std::vector<CanMessage> foreign;
};

TEST(Check, RequireProvedNamesEachEstimatedBound) {
  const Fixture fixture;
  const CheckInput input = fixture.input();
  CheckOptions options;
  options.proved.limits = Limits{};
  for (const KernelSlack& kernel : check(input, {}).kernels) {
    options.proved.instructions[kernel.name] = 1'000;
  }
  options.require_proved = true;
  const CheckResult proved = check(input, options);
  EXPECT_TRUE(proved.fails.empty()) << proved.fails.front();
  const TaskNode& node = proved.analysis_input.model.groups[0].nodes[0];
  EXPECT_EQ(node.bound_ns, static_cast<std::int64_t>(1'000 * fixture.board.ns_per_instruction));
  EXPECT_EQ(check_json(input, options, proved)["nodes"][0]["kind"], "proved");

  options.proved.instructions.erase("FindBlobs");
  options.proved.refused["FindBlobs"] = "the program has other machine code than the proof";
  const CheckResult estimated = check(input, options);
  ASSERT_EQ(estimated.fails.size(), 1U);
  EXPECT_EQ(estimated.fails.front(),
            "FindBlobs: the bound is estimated, expected a proved one: the program has other "
            "machine code than the proof");
  EXPECT_NE(check_table(input, estimated).find("estimated FindBlobs"), std::string::npos);

  options.proved.limits.blobs = 8;
  EXPECT_EQ(check(input, options).fails.size(), proved.kernels.size());
}

TEST(Check, HoldsOnAFastBoardAndGivesEveryKeyThatItsReadersNeed) {
  const Fixture fixture;
  const CheckInput input = fixture.input();
  const CheckResult result = check(input, {});
  ASSERT_TRUE(result.fails.empty()) << result.fails.front();
  const auto json = check_json(input, {}, result);
  for (const char* key :
       {"board", "board_sha256", "plan", "cores", "limits", "void", "groups", "nodes", "chains",
        "can", "bus_load", "system_slack_percent", "break_even_clock", "largest", "estimates",
        "margin_percent", "verdict", "fails"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["verdict"], "holds");
  EXPECT_TRUE(json["void"].empty());
  EXPECT_EQ(json["groups"].size(), 2U);
  EXPECT_EQ(json["chains"].size(), 2U);
  EXPECT_GT(json["system_slack_percent"].get<double>(), 0);
  EXPECT_LT(json["break_even_clock"].get<double>(), 1);
  EXPECT_GE(result.tools_largest, 1);
  const std::string table = check_table(input, result);
  EXPECT_NE(table.find("chain frame_to_can"), std::string::npos);
  EXPECT_NE(table.find("estimate"), std::string::npos);
}

TEST(Check, BreakEvenClockHoldsAndABitLessDoesNot) {
  const Fixture fixture;
  const CheckResult result = check(fixture.input(), {});
  ASSERT_TRUE(result.system);
  CheckOptions options;
  options.clock = 1 / *result.system * 1.0001;
  EXPECT_TRUE(assess(analysis_input_of(fixture.input(), options)).holds());
  options.clock = 1 / *result.system * 0.999;
  EXPECT_FALSE(assess(analysis_input_of(fixture.input(), options)).holds());
  const CheckResult slow = check(fixture.input(), options);
  EXPECT_FALSE(slow.fails.empty());
  EXPECT_EQ(check_json(fixture.input(), options, slow)["void"].size(), 1U);
}

// Percentage at the end of the row that starts with `words`.
double percent_in(const std::string& table, const std::string& words) {
  const std::size_t at = table.find("\n" + words + " ");
  EXPECT_NE(at, std::string::npos) << words << " has no row in\n" << table;
  if (at == std::string::npos) return 0;
  const std::string row = table.substr(at + 1, table.find('\n', at + 1) - at - 1);
  EXPECT_EQ(row.find_last_of("0123456789"), row.size() - 1) << row;
  return std::strtod(row.c_str() + row.rfind(' '), nullptr);
}

TEST(Check, ShowsTheSlackOfEveryNodeOfEveryChainAndOfTheSystem) {
  const Fixture fixture(5.0);
  const CheckResult result = check(fixture.input(), {});
  const std::string table = slack_table(result);
  for (const KernelSlack& slack : result.kernels) {
    ASSERT_TRUE(slack.all_copies);
    const std::string name = "node   " + slack.name;
    if (*slack.all_copies < k_factor_max) {
      EXPECT_NEAR(percent_in(table, name), slack_percent(*slack.all_copies), 0.051) << name;
    } else {
      EXPECT_NE(table.find(name), std::string::npos);
    }
  }
  ASSERT_EQ(result.chains.size(), 2U);
  for (std::size_t c = 0; c < result.chains.size(); ++c) {
    EXPECT_NEAR(percent_in(table, "chain  " + result.assessment.chains[c].name),
                slack_percent(*result.chains[c]), 0.051);
  }
  EXPECT_NEAR(percent_in(table, "system"), slack_percent(*result.system), 0.051);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'),
            static_cast<std::ptrdiff_t>(1 + result.kernels.size() + 2 + 1));
  EXPECT_NE(check_table(fixture.input(), result).find(node_slack_rows(result)), std::string::npos);
}

TEST(Check, ScalesOneKernelUpToItsSlackAndNoFurther) {
  const Fixture fixture(5.0);  // slow enough that the slack of FindBlobs is finite
  const CheckResult result = check(fixture.input(), {});
  for (const KernelSlack& slack : result.kernels) {
    if (slack.name != "FindBlobs") continue;
    ASSERT_TRUE(slack.all_copies);
    ASSERT_LT(*slack.all_copies, k_factor_max);
    CheckOptions options;
    options.scale["FindBlobs"] = *slack.all_copies;
    EXPECT_TRUE(assess(analysis_input_of(fixture.input(), options)).holds());
    options.scale["FindBlobs"] = *slack.all_copies * 1.001;
    EXPECT_FALSE(assess(analysis_input_of(fixture.input(), options)).holds());
  }
  CheckOptions unknown;
  unknown.scale["blob"] = 1.3;
  EXPECT_THROW((void)check(fixture.input(), unknown), InputError);
}

TEST(Check, FailsBelowThePolicysMarginAndAboveAnObservation) {
  const Fixture fixture;
  const double slack = 100 * (*check(fixture.input(), {}).system - 1);
  CheckOptions options;
  options.margin_percent = slack + 1;
  EXPECT_EQ(check(fixture.input(), options).fails.size(), 1U);
  options.margin_percent = slack - 1;
  EXPECT_TRUE(check(fixture.input(), options).fails.empty());

  options.observed = testing::TempDir() + "observed_summary.json";
  for (const double max_us : {5.0, 1e6}) {
    std::ofstream(options.observed) << "{\"frame_to_can_us\": {\"max\": " << max_us << "}}";
    const CheckResult result = check(fixture.input(), options);
    EXPECT_EQ(result.fails.empty(), max_us < 100);
    if (!result.fails.empty()) {
      EXPECT_EQ(result.fails.front().find("frame to CAN: observed 1000000.0 us, bound "), 0U);
    }
  }
  std::ofstream(options.observed) << "{}";
  EXPECT_THROW((void)check(fixture.input(), options), InputError);
  std::ofstream(options.observed)
      << R"({"frame_to_can_kind": "nominal", "frame_to_can_us": {"max": 1.0}})";
  EXPECT_THROW((void)check(fixture.input(), options), InputError);
  for (const char* of_another_type :
       {R"({"frame_to_can_us": {"max": "x"}})", R"({"frame_to_can_us": 1})",
        R"({"frame_to_can_kind": 1, "frame_to_can_us": {"max": 1.0}})"}) {
    std::ofstream(options.observed) << of_another_type;
    EXPECT_THROW((void)check(fixture.input(), options), InputError) << of_another_type;
  }
  std::remove(options.observed.c_str());
}

TEST(Check, SaysThatAPlanOfAnotherBoardFileIsVoid) {
  Fixture fixture;
  fixture.plan.board_sha256 = std::string(64, '1');
  const CheckInput input = fixture.input();
  EXPECT_EQ(check_json(input, {}, check(input, {}))["void"].size(), 1U);
}

TEST(Check, RefusesAPlanMadeForFewerToolsThanTheCellHas) {
  Fixture fixture;
  TaskModel model =
      task_model_of(fixture.cell, fixture.board.table(), fixture.board.system, small_limits());
  model.cores = fixture.plan.cores;
  fixture.plan.graph_signature = graphs_signature(model);
  const std::string file = testing::TempDir() + "plan_of_one_tool.toml";
  std::ofstream(file) << plan_text(fixture.plan, model);
  Limits limits = small_limits();
  EXPECT_EQ(validated_plan(file, model, limits).traffic.tools, 1);
  limits.tools = 2;
  try {
    (void)validated_plan(file, model, limits);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), file + ": made for 1 tools; expected 2 as in the cell");
  }
  std::remove(file.c_str());
}

TEST(BusFrames, CarryWhatTheCellSendsAndNoIdentifierTwice) {
  const Cell cell = default_cell();
  const auto own = own_frames_of(cell, 2);
  // Two tools of five frames each, heartbeat, two time frames, an emergency each.
  EXPECT_EQ(own.size(), 2U * 5 + 1 + 2 + 2);
  EXPECT_EQ(own.front().identifier, cell.can.base_id);
  for (const CanMessage& frame : own) EXPECT_TRUE(frame.fifo);
}

// Check of the flat board with these lines of a cell.
CheckResult check_of(const std::string& lines) {
  Fixture fixture;
  fixture.cell = cell_from_text(lines, "cell.toml");
  return check(fixture.input(), {});
}

std::int64_t sampling_ns(const CheckResult& result) {
  for (const ChainStage& stage : result.assessment.chains.at(0).stages) {
    if (stage.name == "sampling") return stage.ns;
  }
  return 0;
}

TEST(Check, CountsATickEachShortestGapWhereEstimatesReleaseThem) {
  const std::string estimate = "[rates]\ntick_release = \"estimate\"\n";
  const CheckResult by_clock = check_of(""), by_estimates = check_of(estimate);
  EXPECT_TRUE(by_estimates.fails.empty()) << by_estimates.fails.front();
  EXPECT_EQ(sampling_ns(by_clock), 4'000'000);
  EXPECT_EQ(sampling_ns(by_estimates), 2'500'000);
  EXPECT_EQ(by_estimates.assessment.groups[1].deadline_ns, 2'500'000);
  EXPECT_LT(by_estimates.assessment.chains[0].total_ns, by_clock.assessment.chains[0].total_ns);
  // Heartbeat, time and emergencies keep their gaps.
  EXPECT_GT(by_estimates.bus_load, by_clock.bus_load * 1.55);
  EXPECT_LT(by_estimates.bus_load, by_clock.bus_load * 1.60);
}

TEST(Check, FailsOnABusThatCannotCarryASetEachShortestGap) {
  const std::string bus = "[can]\nbit_rate = 250_000\n";
  EXPECT_LT(check_of(bus).bus_load, 1);
  const CheckResult result = check_of(bus + "[rates]\ntick_release = \"estimate\"\n");
  EXPECT_GT(result.bus_load, 1);
  ASSERT_FALSE(result.fails.empty());
  EXPECT_EQ(result.fails.front(), "CAN frame tool 1 position: bound none, deadline 2500.0 us");
}

std::string refusal(const std::string& text) {
  try {
    (void)foreign_frames_from_text(text, "foreign.toml", own_frames_of(default_cell(), 1));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BusFrames, OfOthersAreReadAndRefusedByLine) {
  const std::string good =
      "[[frame]]\nname = \"torque\"\nidentifier = 0x120\nbytes = 8\nperiod_ms = 4\n"
      "jitter_ms = 0.2\nnode = \"drive\"\nqueue = \"fifo\"\n";
  const auto frames =
      foreign_frames_from_text(good, "foreign.toml", own_frames_of(default_cell(), 1));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].period_ns, 4'000'000);
  EXPECT_EQ(frames[0].jitter_ns, 200'000);
  EXPECT_EQ(frames[0].deadline_ns, 4'000'000);
  EXPECT_TRUE(frames[0].fifo);
  EXPECT_NE(frames[0].node, own_frames_of(default_cell(), 1)[0].node);

  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refusal(with("0x120", "0x800")).find("foreign.toml:3: frame.identifier is 2048"), 0U);
  EXPECT_NE(refusal(with("0x120", "0x1A0")).find("is also that of tool 1 position"),
            std::string::npos);
  EXPECT_NE(refusal(with("bytes = 8", "bytes = 9")).find("from 0 to 8"), std::string::npos);
  EXPECT_NE(refusal(with("period_ms = 4\n", "")).find("no period_ms"), std::string::npos);
  EXPECT_NE(refusal(with("jitter_ms = 0.2", "jitter_ms = 5")).find("from 0 to 4"),
            std::string::npos);
  EXPECT_NE(refusal(good + good).find("is also that of torque"), std::string::npos);
  std::string mixed = good + with("0x120", "0x121");
  mixed.replace(mixed.rfind("fifo"), 4, "priority");
  EXPECT_NE(refusal(mixed).find("queue differs"), std::string::npos);
}

}  // namespace
}  // namespace glint::check_test
