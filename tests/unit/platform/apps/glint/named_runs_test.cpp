// Two `glint run --name` in one DDS domain: separate topics, inputs and nodes.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "platform/sinks/dds/ros_node.hpp"
#include "tests/unit/platform/apps/glint/command_process.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/peer.hpp"
#include "tests/unit/platform/sinks/dds/samples.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using NamedRuns = DdsTest;

nlohmann::json summary_in(const std::string& folder) {
  std::ifstream file(folder + "/summary.json");
  return nlohmann::json::parse(file);
}

TEST_F(NamedRuns, DoNotDisturbEachOther) {
  const test::Files files;
  const std::string cell = files.write(
      "cell.toml",
      "tools = [\"pen\"]\n[dds]\nallow = [\"buttons\"]\nros_graph = \"iron\"\n"
      "[overrun]\nwatch = false\n[simulator]\nscenario = \"still\"\nduration_s = 600\n");
  const auto arguments = [&](const std::string& name) {
    const std::string out = files.folder() + "/" + name;
    return std::vector<std::string>{"run",   "--name", name,     "--config",           cell,
                                    "--out", out,      "--json", out + "/summary.json"};
  };
  Peer peer(test_settings());
  const auto reader = [&](const TopicType& type, const std::string& topic) {
    return peer.reader(type, topic, Reliability::reliable, Durability::volatile_data, 1);
  };
  const dds_entity_t left_status = reader(status_type(), "rt/left/glint/pen_status");
  const dds_entity_t right_status = reader(status_type(), "rt/right/glint/pen_status");
  const dds_entity_t right_tf = reader(tf_type(), "rt/right/tf");
  const std::vector<dds_entity_t> without_name{reader(status_type(), "rt/glint/pen_status"),
                                               reader(tf_type(), k_tf_topic),
                                               reader(diagnostics_type(), k_diagnostics_topic)};
  const dds_entity_t button = peer.writer(bool_type(), "rt/left/glint/button",
                                          Reliability::reliable, Durability::volatile_data, 1);
  CommandProcess left(arguments("left"), files.folder() + "/left.txt");
  CommandProcess right(arguments("right"), files.folder() + "/right.txt");
  EXPECT_TRUE(left.repeat_until([] {},
                                [&] {
                                  return has_writer(left_status) && has_writer(right_status) &&
                                         has_writer(right_tf) && has_reader(button);
                                }));
  for (const dds_entity_t none : without_name) EXPECT_FALSE(has_writer(none));
  const BoolMessage pressed{true};
  ASSERT_EQ(dds_write(button, &pressed), DDS_RETCODE_OK);
  EXPECT_EQ(take<StatusMessage>(left_status, 500, [](const StatusMessage&) {}) >= 500, true);
  for (CommandProcess* run : {&left, &right}) {
    ASSERT_FALSE(run->has_ended()) << run->words();
    run->interrupt();
  }
  for (CommandProcess* run : {&left, &right}) EXPECT_EQ(run->exit_code(), 0) << run->words();
  for (const std::string name : {"left", "right"}) {
    const nlohmann::json summary = summary_in(files.folder() + "/" + name);
    EXPECT_EQ(summary.at("dds_missed"), 0) << name;
    EXPECT_EQ(summary.at("dds_received"), summary.at("dds_written")) << name;
    EXPECT_EQ(summary.at("dds_input").at("buttons"), name == "left" ? 1 : 0) << name;
    EXPECT_EQ(summary.at("dds_input").at("refused"), 0) << name;
  }
}

}  // namespace
}  // namespace glint
