// `glint run` as a live process that tracks a robot; the test publishes the joint states.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/platform/apps/glint/command_process.hpp"
#include "tests/unit/platform/runtime/session/box_on_a_slide.hpp"
#include "tests/unit/platform/sinks/dds/diagnostic_entry.hpp"
#include "tests/unit/platform/sinks/dds/isolated_network.hpp"
#include "tests/unit/platform/sinks/dds/robot_speaker.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

constexpr double k_robot_x_m = 0.6;  // x of the robot in the cell of run_of()

// The run publishes counts of its depth images on /diagnostics each second; the tests wait for
// them.
class HeardJointsOfARun : public DdsTest {
 protected:
  // Arguments of a run whose cell has these additional [mapping] keys.
  [[nodiscard]] std::vector<std::string> run_of(const std::string& mapping) const {
    const std::string cell_file = files_.write(
        "cell.toml",
        "tools = [\"pen\"]\n[dds]\nallow = [\"joint_states\"]\n[simulator]\nduration_s = "
        "600\n[background]\nperiod_ms = 1\n[robot]\n"
        "position_mm = [600, 0, -400]\n[mapping]\nsource = \".\"\nperiod_ms = 100\n"
        "pictures_a_map = 1000\nstride = 8\nvoxels_max = 20_000\nmodel = "
        "\"robot.ply\"\njoints = [0]\n" +
            mapping);
    Cell cell = load_cell(cell_file);
    configure_sliding_box(files_.folder(), cell);
    return {"run", "--config", cell_file, "--out", files_.folder(), "--json", path("summary.json")};
  }
  [[nodiscard]] std::string path(const char* name) const { return files_.folder() + "/" + name; }

  // The robot's count `key` in the newest message; 0 before the first message.
  [[nodiscard]] long robot_count(const char* key) {
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(diagnostics_, sample, &info, 1, 1) == 1) {
      if (info.valid_data) {
        robot_ = entry_of(*static_cast<const DiagnosticsMessage*>(sample[0]), "glint: robot");
      }
      dds_return_loan(diagnostics_, sample, 1);
    }
    const auto found = robot_.values.find(key);
    return found == robot_.values.end() ? 0 : std::stol(found->second);
  }
  // Whether tf_static ever held a robot position other than the cell's.
  [[nodiscard]] bool was_moved_in_tf() const {
    bool moved = false;
    void* sample[1] = {nullptr};
    dds_sample_info_t info;
    while (dds_take(statics_, sample, &info, 1, 1) == 1) {
      const auto* message = static_cast<const TfMessage*>(sample[0]);
      for (std::uint32_t i = 0; info.valid_data && i < message->transforms._length; ++i) {
        const TransformMessage& one = message->transforms._buffer[i];
        const bool robot = std::string_view(one.child_frame_id) == "robot_base";
        moved = moved || (robot && one.transform.translation.x != k_robot_x_m);
      }
      dds_return_loan(statics_, sample, 1);
    }
    return moved;
  }
  // Interrupts the run and returns the references of its summary.
  [[nodiscard]] nlohmann::json end(CommandProcess& run) const {
    run.interrupt();
    EXPECT_EQ(run.exit_code(), 0) << run.words();
    std::ifstream file(path("summary.json"));
    return nlohmann::json::parse(file).at("background").at("references");
  }

  const test::Files files_;
  SimulatedRobotDriver driver_{{"gripper", "slide"}, {9, 0}};
  dds_entity_t diagnostics_ =
      driver_.peer().reader(diagnostics_type(), k_diagnostics_topic, Reliability::reliable,
                            Durability::volatile_data, 10);
  dds_entity_t statics_ = driver_.peer().reader(tf_type(), k_tf_static_topic, Reliability::reliable,
                                                Durability::transient_local, 1000);
  DiagnosticEntry robot_;
};

TEST_F(HeardJointsOfARun, LetItFollowWhatItCannotFollowWithoutThem) {
  CommandProcess run(run_of(""), path("words.txt"));
  ASSERT_TRUE(run.repeat_until(
      [] {}, [&] { return robot_count("unsure") + robot_count("jumps_refused") >= 1; }));
  ASSERT_FALSE(run.has_ended()) << run.words();
  EXPECT_EQ(robot_count("followed"), 0);
  EXPECT_FALSE(was_moved_in_tf());
  double slide = 0;
  const auto move = [&] {
    slide = std::min(slide + 0.01, k_slide_shown_m);
    driver_.move_to({9, slide});
    driver_.publish_joints();
  };
  EXPECT_TRUE(run.repeat_until(move, [&] { return robot_count("followed") >= 1; }));
  EXPECT_TRUE(run.repeat_until([] {}, [&] { return was_moved_in_tf(); }));
  ASSERT_FALSE(run.has_ended()) << run.words();
  const nlohmann::json robot = end(run);
  EXPECT_GE(robot.at("followed"), 1);
  EXPECT_GE(robot.at("joint_states_used"), 1);
  EXPECT_EQ(robot.at("joint_states_passed_over"), 0);
}

TEST_F(HeardJointsOfARun, AreMissedWhenTheyStopAndServeWhenTheyComeAgain) {
  CommandProcess run(run_of("joints_lost_after_ms = 500\n"), path("words.txt"));
  driver_.move_to({9, k_slide_shown_m});
  const auto speak = [&] { driver_.publish_joints(); };
  const auto warns = [&] { return robot_count("without_joints") > 0 && robot_.level == 1; };
  ASSERT_TRUE(run.repeat_until(speak, [&] { return robot_count("followed") >= 1; }));
  EXPECT_TRUE(run.repeat_until([] {}, warns));
  EXPECT_EQ(robot_.message, "not tracked: joint states are too old; check the robot's driver");
  const long followed = robot_count("followed");
  EXPECT_TRUE(run.repeat_until(
      speak, [&] { return robot_count("followed") >= followed + 2 && robot_.level == 0; }));
  ASSERT_FALSE(run.has_ended()) << run.words();
  EXPECT_GE(end(run).at("pictures_without_joints"), 1);
  EXPECT_NE(run.words().find("rt/joint_states: no state for longer than mapping.joints_lost_after"),
            std::string::npos);
}

}  // namespace
}  // namespace glint
