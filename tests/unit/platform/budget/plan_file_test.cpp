#include "platform/budget/plan_file.hpp"

#include <gtest/gtest.h>

#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"
#include "schedules/synthesis.hpp"

namespace glint {
namespace {

// The default cell's groups on two cores, with bounds as in a board file.
TaskModel bounded_model() {
  TaskModel model = task_structure_of(default_cell());
  model.cores = 2;
  for (TaskGroup& group : model.groups) {
    std::int64_t bound = 1'000;
    for (TaskNode& node : group.nodes) node.bound_ns = bound += 700;
  }
  model.system.inter_core_delay_ns = 300;
  return model;
}

Plan schedule_of(const TaskModel& model) {
  Plan plan = synthesize(model);
  plan.graph_signature = graphs_signature(model);
  plan.board = "toy";
  plan.board_sha256 = "00ff";
  plan.traffic = traffic_of(default_cell());
  plan.bus = bit_rates_of(default_cell());
  return plan;
}

Plan read(const std::string& text, const TaskModel& model) {
  return plan_from_text(text, "plan.toml", model, graphs_signature(model));
}

std::string refusal(const std::string& text) {
  try {
    (void)read(text, bounded_model());
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// The schedule's text with its first `from` replaced.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = plan_text(schedule_of(bounded_model()), bounded_model());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " in\n" << text;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(PlanFile, ReadsBackWhatItWrote) {
  const TaskModel model = bounded_model();
  const Plan plan = schedule_of(model);
  const Plan again = read(plan_text(plan, model), model);
  EXPECT_EQ(plan_text(again, model), plan_text(plan, model));
  EXPECT_TRUE(check_plan(again, model).empty());
  for (int group = 0; group < 2; ++group) {
    EXPECT_EQ(core_orders(again, group), core_orders(plan, group));
  }
  EXPECT_EQ(again.groups[0].makespan_ns, plan.groups[0].makespan_ns);
  EXPECT_TRUE(again.groups[0].optimal);
}

TEST(PlanFile, KnowsTheTrackersOrderOfDataAndCopies) {
  const TaskModel model = task_structure_of(default_cell());
  const auto& nodes = model.groups[0].nodes;
  const auto index = [&](const std::string& name) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (node_name(nodes[n]) == name) return static_cast<int>(n);
    }
    return -1;
  };
  const auto& blobs = nodes[static_cast<std::size_t>(index("FindBlobs"))].after;
  for (int band = 0; band < k_row_bands; ++band) {
    const int copy = index("RoiThreshold#" + std::to_string(band));
    EXPECT_EQ(std::count(blobs.begin(), blobs.end(), copy), 1);
  }
  EXPECT_TRUE(nodes.front().after.empty());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (const int before : nodes[n].after) EXPECT_LT(before, static_cast<int>(n));
  }
}

TEST(PlanFile, ComputesTheStartsThatAPersonLeavesOut) {
  const TaskModel model = bounded_model();
  const Plan plan = schedule_of(model);
  std::string text = plan_text(plan, model);
  for (std::size_t at = text.find(", start_ns"); at != std::string::npos;
       at = text.find(", start_ns")) {
    if (text.find(", bound_ns", at) == std::string::npos) break;
    text.erase(at, text.find(", bound_ns", at) - at);
  }
  EXPECT_EQ(plan_text(read(text, model), model), plan_text(plan, model));
}

struct Refused {
  const char* from;
  const char* to;
  const char* said;
};

TEST(PlanFile, RefusesWhatDoesNotFitWithItsLineAndWhatWould) {
  const Refused cases[] = {
      {"graph = \"0x", "graph = \"0y", "plan.toml:4: graph is \"0y"},
      {"cores = 2", "cores = 9", "plan.toml:7: cores is 9; expected a whole number from 1 to 4"},
      {"\"StampFrame\", core = 0", "\"StampFrame\", core = 2",
       "plan.toml:22: StampFrame on core 2; expected 0 to 1"},
      {"\"StampFrame\"", "\"StampedFrame\"",
       "plan.toml:22: node \"StampedFrame\" is not in group \"frame\"; expected one of StampFrame"},
      {"\"CheckFrame\"", "\"StampFrame\"", "plan.toml:23: StampFrame occurs again"},
      {"name = \"tick\"", "name = \"tock\"", "group \"tock\"; expected one of frame, tick"},
      {"priority = ", "priority = 1", "priority is "},
      {"tick_hz = 250", "tick_hz = 1000", "accepted"},
      {"bit_rate = 1000000", "bit_rate = 125000", "plan.toml:9: CAN: 1 tool at 250 Hz"},
      {"tools = 1", "tools = 16", "; 5 would fit"},
      {"{ node = \"StampFrame\"", "{ nodes = \"StampFrame\"", "plan.toml:22: unknown key"},
  };
  for (const Refused& refused : cases) {
    const std::string said = refusal(edited(refused.from, refused.to));
    EXPECT_NE(said.find(refused.said), std::string::npos) << refused.to << ": " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
}

TEST(PlanFile, RefusesALeftOutNodeACycleAndAStartThatCannotBe) {
  const std::string text = plan_text(schedule_of(bounded_model()), bounded_model());
  const auto line_with = [&](const std::string& what) {
    const std::size_t at = text.find(what);
    const std::size_t begin = text.rfind('\n', at) + 1;
    return text.substr(begin, text.find('\n', at) + 1 - begin);
  };
  const auto without = [](std::string from, const std::string& part) {
    return from.erase(from.find(part), part.size());
  };
  const std::string find_blobs = line_with("\"FindBlobs\"");
  EXPECT_NE(refusal(without(text, find_blobs)).find("group \"frame\" leaves out FindBlobs"),
            std::string::npos);

  // FindBlobs first on its core: it waits for nodes that the same core runs later.
  std::string early = find_blobs;
  early.erase(early.find(", start_ns"), early.find(", bound_ns") - early.find(", start_ns"));
  std::string cycle = without(text, find_blobs);
  cycle.insert(cycle.find("  { node = \"StampFrame\""), early);
  EXPECT_NE(refusal(cycle).find("a cycle: FindBlobs waits for RoiThreshold#"), std::string::npos)
      << refusal(cycle);

  std::string hurried = find_blobs;
  const std::size_t start = hurried.find("start_ns = ") + 11;
  hurried.erase(start, hurried.find(',', start) - start);
  hurried.insert(start, std::string("7"));
  std::string impossible = text;
  impossible.replace(impossible.find(find_blobs), find_blobs.size(), hurried);
  EXPECT_NE(refusal(impossible).find("FindBlobs starts at 7 ns; expected at least "),
            std::string::npos)
      << refusal(impossible);
}

}  // namespace
}  // namespace glint
