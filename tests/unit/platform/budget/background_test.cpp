// Background group of a cell's [background] section in schedules, checks and board files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "nodes/mapper.hpp"
#include "platform/budget/check.hpp"
#include "platform/budget/plan_file.hpp"
#include "platform/budget/slack_table.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"
#include "schedules/sensitivity.hpp"
#include "schedules/synthesis.hpp"
#include "tests/unit/platform/budget/flat_board.hpp"

namespace glint::background_test {
namespace {

constexpr int k_steps = 1'000;
constexpr auto k_background = static_cast<std::size_t>(k_background_group_index);

Cell cell_with(const std::string& background) {
  return cell_from_text("name = \"background\"\n" + background, "cell.toml");
}

struct Fixture {
  explicit Fixture(int cores = 2,
                   const std::string& background = "[background]\nperiod_ms = 50\nsteps = 1000\n",
                   double ns_a_count = 0.2)
      : cell(cell_with(background)), board(uniform_costs(ns_a_count)), limits(small_limits()) {
    limits.background_steps = k_steps;
    limits.tracking_steps = 0;  // no robot is tracked
    model = task_model_of(cell, board.table(), board.system, limits);
    model.cores = cores;
    plan = synthesize(model);
    plan.graph_signature = graphs_signature(model);
    plan.board_sha256 = board.sha256;
  }
  [[nodiscard]] CheckInput input() const { return {cell, board, plan, limits, {}}; }
  [[nodiscard]] Plan read(const std::string& text) const {
    return plan_from_text(text, "plan.toml", model, graphs_signature(model));
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  Cell cell;
  Board board;
  Limits limits;
  TaskModel model;
  Plan plan;
};

// 0.2 ns for the call and for each step, including those of the last point; rounded up.
constexpr std::int64_t k_slice_ns = 2'801;
static_assert(5 * (k_slice_ns - 1) == k_steps + k_map_item_steps_max);
constexpr std::int64_t k_idle_ns = 1;  // FollowRobot without a robot

TEST(BackgroundGroupOfACell, HasItsPeriodAsGapAndDeadlineAndItsSliceAsBound) {
  const Fixture fixture;
  ASSERT_EQ(fixture.model.groups.size(), 3U);
  const TaskGroup& group = fixture.model.groups[k_background];
  EXPECT_EQ(group.name, "background");
  EXPECT_TRUE(group.resumable);
  EXPECT_EQ(group.min_gap_ns, 50'000'000);
  EXPECT_EQ(group.deadline_ns, 50'000'000);
  ASSERT_EQ(group.nodes.size(), 2U);
  EXPECT_EQ(group.nodes[0].name, "ExtendMap");
  EXPECT_EQ(group.nodes[0].bound_ns, k_slice_ns);
  EXPECT_EQ(group.nodes[1].name, "FollowRobot");
  EXPECT_EQ(group.nodes[1].bound_ns, k_idle_ns);
  EXPECT_EQ(group.longest_slice_ns, k_slice_ns + k_idle_ns);
}

TEST(BackgroundGroupOfACell, IsNoneWhereTheCellHasNone) {
  const Cell cell = default_cell();
  const TaskModel model = task_structure_of(cell);
  EXPECT_EQ(model.groups.size(), 2U);
  const Fixture with;
  const std::string two = graphs_signature(model), three = graphs_signature(with.model);
  EXPECT_EQ(three.substr(0, two.size() + 1), two + "+");
  EXPECT_EQ(three.size(), two.size() + 19);
}

TEST(BackgroundGroupOfACell, NeedsABoardThatPricesItsSlice) {
  Board board = uniform_costs(0.2);
  std::erase_if(board.kernels,
                [](const auto& kernel) { return kernel.loops.kernel == "ExtendMap"; });
  compute_costs(board);
  const Limits limits = small_limits();
  EXPECT_NO_THROW((void)task_model_of(default_cell(), board.table(), board.system, limits));
  try {
    (void)task_model_of(cell_with("[background]\n"), board.table(), board.system, limits);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "flat: no cost of ExtendMap; expected one of each of its loops");
  }
}

// A board file may leave out the background graph; it then serves every cell without one.
TEST(BackgroundGroupOfACell, IsPricedByTheBuiltInBoardsThatNameItsGraph) {
  int priced = 0;
  for (const std::string& name : built_in_boards()) {
    // The build of another compiler rejects all board files; this test checks costs only.
    const Cell cell = cell_with("[background]\n");
    Board board;
    try {
      board = load_board(name, expected_board(), BoardUse::analyse);
    } catch (const InputError& error) {
      if (std::string(error.what()).find(": build is ") == std::string::npos) throw;
      GTEST_SKIP() << error.what();
    }
    if (board.graphs.size() == 2) continue;
    ++priced;
    const TaskModel model = task_model_of(cell, board.table(), board.system, limits_of(cell));
    EXPECT_GT(model.groups[k_background].longest_slice_ns, k_background_steps_max) << name;
  }
  EXPECT_GE(priced, 1);
}

TEST(BackgroundPlanFile, ReadsBackWhatItWrote) {
  const Fixture fixture;
  const std::string text = plan_text(fixture.plan, fixture.model);
  EXPECT_NE(text.find("name = \"background\"\n"), std::string::npos);
  const Plan again = fixture.read(text);
  EXPECT_EQ(plan_text(again, fixture.model), text);
  EXPECT_TRUE(check_plan(again, fixture.model).empty());
}

TEST(BackgroundPlanFile, OfOtherGroupsThanTheCellsIsRefusedEitherWay) {
  const Fixture with;
  const Fixture without(2, "");
  EXPECT_NE(with.refusal(plan_text(without.plan, without.model))
                .find("this program's graphs of the cell's groups frame, tick, background"),
            std::string::npos);
  const std::string said = without.refusal(plan_text(with.plan, with.model));
  EXPECT_EQ(said.find("plan.toml:4: graph is \""), 0U) << said;
  EXPECT_NE(said.find("the cell's groups frame, tick"), std::string::npos) << said;
}

// Manual edits: another core, another position in the file, another priority.
TEST(BackgroundPlanFile, EditedByHandIsJudgedAgain) {
  const Fixture fixture;
  const std::string text = plan_text(fixture.plan, fixture.model);
  const std::size_t from = text.find("\n[[group]]", text.find("name = \"tick\""));
  const std::string third = text.substr(from);
  ASSERT_NE(third.find("ExtendMap"), std::string::npos);
  for (const char* const core : {"core = 0", "core = 1"}) {
    std::string moved = third;
    for (std::size_t at = 0; (at = moved.find("core = ", at)) != std::string::npos; at += 8)
      moved.replace(at, 8, core);
    // Missing start times are computed.
    const std::string start = "start_ns = 0, ";
    for (std::size_t at = 0; (at = moved.find(start)) != std::string::npos;)
      moved.erase(at, start.size());
    // Before the other groups in the file: groups are identified by name.
    std::string first = text.substr(0, from);
    first.insert(first.find("\n[[group]]"), moved);
    const Plan plan = fixture.read(first);
    EXPECT_TRUE(check_plan(plan, fixture.model).empty());
    EXPECT_EQ(plan.groups[k_background].name, "background");
    EXPECT_EQ(plan.nodes.back().core, core[7] - '0');
    CheckInput input = fixture.input();
    input.plan = plan;
    const CheckResult result = check(input, {});
    EXPECT_TRUE(result.fails.empty()) << result.fails.front();
  }
  const auto edited = [&](const std::string& what, const std::string& to) {
    std::string other = third;
    const std::size_t at = other.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.substr(0, from) + other.replace(at, what.size(), to);
  };
  const Plan urgent = fixture.read(edited("priority = 42", "priority = 60"));
  const auto faults = check_plan(urgent, fixture.model);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].find("background: priority 60; expected below 45"), 0U) << faults[0];
  const Plan inexpensive = fixture.read(edited("bound_ns = 2801", "bound_ns = 2800"));
  ASSERT_EQ(check_plan(inexpensive, fixture.model).size(), 1U);
  EXPECT_NE(check_plan(inexpensive, fixture.model)[0].find("expected at least its bound, 2801 ns"),
            std::string::npos);
  EXPECT_NE(fixture.refusal(edited("core = ", "core = 9")).find("ExtendMap on core 9"),
            std::string::npos);
  EXPECT_NE(fixture.refusal(text.substr(0, from)).find("no group \"background\""),
            std::string::npos);
}

TEST(BackgroundCheck, ShowsTheGroupItsSlackAndTheRowsThatItsSliceBlocks) {
  const Fixture fixture(1);
  const CheckInput input = fixture.input();
  const CheckResult result = check(input, {});
  ASSERT_TRUE(result.fails.empty()) << result.fails.front();
  const auto json = check_json(input, {}, result);
  ASSERT_EQ(json["groups"].size(), 3U);
  EXPECT_EQ(json["groups"][2]["name"], "background");
  EXPECT_NEAR(json["groups"][0]["blocking_us"].get<double>(), 2.802, 1e-9);
  EXPECT_NEAR(json["groups"][1]["blocking_us"].get<double>(), 2.802, 1e-9);
  EXPECT_EQ(json["groups"][2]["blocking_us"], 0.0);
  EXPECT_EQ(json["nodes"].back()["name"], "FollowRobot");
  const std::string table = check_table(input, result);
  EXPECT_NE(table.find("\nbackground "), std::string::npos);
  EXPECT_NE(table.find("  frame: blocked by a slice "), std::string::npos);
  EXPECT_NE(table.find("  tick: blocked by a slice "), std::string::npos);
  EXPECT_NE(node_slack_rows(result).find("node   ExtendMap"), std::string::npos);
}

TEST(BackgroundCheck, ScaledByHandMakesTheSliceAndWhatItBlocksGrow) {
  const Fixture fixture(1);
  const auto found = [&](double factor) {
    CheckOptions options;
    options.scale["ExtendMap"] = factor;
    return assess(analysis_input_of(fixture.input(), options));
  };
  const Assessment one = found(1), more = found(1.3);
  for (const std::size_t g : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_EQ(one.groups[g].blocking_ns, k_slice_ns + k_idle_ns);
    EXPECT_EQ(more.groups[g].blocking_ns, 3'642 + k_idle_ns);  // 3641.3, rounded up
    EXPECT_EQ(*more.groups[g].response_ns, *one.groups[g].response_ns + 841);
  }
  EXPECT_EQ(more.groups[k_background].times.makespan_ns, 3'642 + k_idle_ns);
}

TEST(BackgroundCheck, FindsTheFactorThatASliceMayGrowByAndNoMore) {
  // Slices of 70 us: a tick of 4 ms has time for less than a thousand of them.
  const Fixture fixture(1, "[background]\n", 5.0);
  const CheckResult result = check(fixture.input(), {});
  const auto named = [](const KernelSlack& kernel) { return kernel.name == "ExtendMap"; };
  const auto found = std::find_if(result.kernels.begin(), result.kernels.end(), named);
  ASSERT_NE(found, result.kernels.end());
  const KernelSlack& slack = *found;
  ASSERT_TRUE(slack.all_copies);
  ASSERT_LT(*slack.all_copies, k_factor_max);
  CheckOptions options;
  options.scale["ExtendMap"] = *slack.all_copies;
  EXPECT_TRUE(assess(analysis_input_of(fixture.input(), options)).holds());
  options.scale["ExtendMap"] = *slack.all_copies * 1.001;
  EXPECT_FALSE(assess(analysis_input_of(fixture.input(), options)).holds());
}

TEST(BackgroundCheck, IsHeldAgainstTheSlicesThatARunSaw) {
  const Fixture fixture;
  CheckOptions options;
  options.observed = testing::TempDir() + "observed_background.json";
  for (const double max_us : {0.1, 1e5}) {
    std::ofstream(options.observed)
        << R"({"frame_to_can_us": {"max": 1.0}, "background": {"response_us": {"max": )" << max_us
        << "}}}";
    const CheckResult result = check(fixture.input(), options);
    EXPECT_EQ(result.fails.empty(), max_us < 1);
    if (!result.fails.empty()) {
      EXPECT_EQ(result.fails[0].find("background group: observed 100000.0 us, bound "), 0U);
    }
  }
  std::remove(options.observed.c_str());
}

}  // namespace
}  // namespace glint::background_test
