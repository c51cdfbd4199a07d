// The scene's shapes, read field by field.
#include "platform/tools/viewer/scene_messages.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "platform/cells/tool_file.hpp"
#include "tests/unit/platform/tools/viewer/collected_messages.hpp"

namespace glint::scene_messages_test {
namespace {

struct ReadMarker {
  std::string frame, name_space;
  std::int32_t id = 0, type = 0, action = 0;
  Pose pose;
  double size_m = 0;
  std::vector<Vector3> points;
};

std::string frame_in(CdrReader& from) {
  (void)from.get<std::int32_t>();
  (void)from.get<std::uint32_t>();
  return from.get_text();
}

std::vector<ReadMarker> markers_in(std::span<const std::uint8_t> cdr) {
  CdrReader from(cdr);
  std::vector<ReadMarker> markers(from.get<std::uint32_t>());
  for (ReadMarker& marker : markers) {
    marker.frame = frame_in(from);
    marker.name_space = from.get_text();
    marker.id = from.get<std::int32_t>();
    marker.type = from.get<std::int32_t>();
    marker.action = from.get<std::int32_t>();
    marker.pose = get_pose(from);
    marker.size_m = get_vector(from).x();
    for (int i = 0; i < 4; ++i) EXPECT_LE(from.get<float>(), 1.0F);
    (void)from.get<std::int32_t>();
    (void)from.get<std::uint32_t>();
    (void)from.get<bool>();
    marker.points.resize(from.get<std::uint32_t>());
    for (Vector3& point : marker.points) point = get_vector(from);
    EXPECT_EQ(from.get<std::uint32_t>(), 0u);
    EXPECT_EQ(from.get_text(), "");
    EXPECT_EQ(frame_in(from), "");
    EXPECT_EQ(from.get_text(), "");
    EXPECT_TRUE(from.get_bytes().empty());
    EXPECT_EQ(from.get<std::uint32_t>(), 0u);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(from.get_text(), "");
    EXPECT_TRUE(from.get_bytes().empty());
    EXPECT_FALSE(from.get<bool>());
  }
  EXPECT_FALSE(from.failed());
  EXPECT_TRUE(from.at_end());
  return markers;
}

ToolSet one_pen() {
  ToolSet tools;
  tools.items[0] = *built_in_tool("pen");
  tools.count = 1;
  return tools;
}

PoseSample at(Time tick, const Vector3& tip) {
  PoseSample sample;
  sample.tick = tick;
  sample.state = TrackState::measured;
  sample.frame = ReferenceFrame::robot;
  sample.pose.translation = tip;
  return sample;
}

std::vector<ReadMarker> written(const SceneMessages& scene) {
  CdrWriter to;
  scene.write(to, Time{} + milliseconds(1));
  return markers_in(to.bytes());
}

TEST(SceneMessages, DrawsTheToolAtItsPose) {
  const ToolSet tools = one_pen();
  SceneMessages scene(tools);
  scene.add(at(Time{}, Vector3(0.1, 0.2, 0.3)));
  const std::vector<ReadMarker> markers = written(scene);
  ASSERT_EQ(markers.size(), 4u);
  EXPECT_EQ(markers[0].frame, "robot_base");
  EXPECT_EQ(markers[0].name_space, "pen");
  EXPECT_EQ(markers[0].action, 0);
  EXPECT_EQ(markers[0].pose.translation, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(markers[0].size_m, 2 * tools.items[0].marker_radius_m);
  ASSERT_EQ(markers[0].points.size(), 5u);
  EXPECT_EQ(markers[0].points[2], tools.items[0].markers_m[2] - tools.items[0].tip_m);
  EXPECT_EQ(markers[1].points.front(), Vector3::Zero()) << "the tip";
}

TEST(SceneMessages, DeletesAToolWithoutPose) {
  const ToolSet tools = one_pen();
  SceneMessages scene(tools);
  scene.add(at(Time{}, Vector3(0.1, 0.2, 0.3)));
  scene.add(PoseSample{});
  for (const ReadMarker& marker : written(scene)) {
    EXPECT_EQ(marker.action, 2) << marker.name_space;
    EXPECT_TRUE(marker.points.empty());
  }
}

TEST(SceneMessages, DrawsTheStrokeWhileTheButtonIsHeld) {
  const ToolSet tools = one_pen();
  SceneMessages scene(tools);
  const auto add_ten = [&](double from_m) {
    for (int i = 0; i < 10; ++i) {
      scene.add(at(Time{} + milliseconds(20 * i), Vector3(from_m + 0.01 * i, 0, 0)));
    }
  };
  add_ten(0);
  EXPECT_TRUE(written(scene)[3].points.empty()) << "the button is not held";
  scene.add(ButtonEvent{Time{}, Button::draw, true});
  add_ten(1);
  const ReadMarker stroke = written(scene)[3];
  EXPECT_EQ(stroke.name_space, "stroke");
  EXPECT_EQ(stroke.frame, "robot_base");
  ASSERT_EQ(stroke.points.size(), 10u);
  EXPECT_EQ(stroke.points.front(), Vector3(1, 0, 0));
  scene.add(ButtonEvent{Time{}, Button::draw, false});
  EXPECT_EQ(written(scene)[3].action, 2);
}

TEST(SceneMessages, KeepsALongStrokeWithinItsMaximum) {
  const ToolSet tools = one_pen();
  SceneMessages scene(tools);
  scene.add(ButtonEvent{Time{}, Button::draw, true});
  constexpr int k_points = 3 * static_cast<int>(k_stroke_points_max);
  for (int i = 0; i < k_points; ++i) {
    scene.add(at(Time{} + milliseconds(10 * i), Vector3(i, 0, 0)));
  }
  const std::vector<Vector3> points = written(scene)[3].points;
  EXPECT_LE(points.size(), k_stroke_points_max);
  EXPECT_GT(points.size(), k_stroke_points_max / 2);
  EXPECT_EQ(points.front().x(), 0);
  EXPECT_GT(points.back().x(), k_points - 16);
}

TEST(ViewedScene, HasHeadsetRobotAndCandidatesOfARun) {
  const Cell cell = short_cell(2);
  CollectedMessages run = collected_run(cell, scenario_of(cell), PicturesTo::observer);
  const auto& scenes = run.messages[std::string(k_scene_topic)];
  EXPECT_GE(scenes.size(), 19u);
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    EXPECT_GE((scenes[i].time - scenes[i - 1].time).seconds(), 0.1);
  }
  std::size_t candidates = 0;
  for (const CollectedMessage& message : scenes) {
    for (const ReadMarker& marker : markers_in(message.cdr)) {
      if (marker.name_space != "candidates") continue;
      EXPECT_EQ(marker.frame, "hmd_tof_optical");
      candidates = std::max(candidates, marker.points.size());
      for (const Vector3& point : marker.points) EXPECT_GT(point.z(), 0);
    }
  }
  EXPECT_GE(candidates, 5u);
  std::set<std::string> transforms;
  for (const CollectedMessage& message : run.messages[std::string(k_transform_topic)]) {
    CdrReader from(message.cdr);
    EXPECT_EQ(from.get<std::uint32_t>(), 1u);
    const std::string parent = frame_in(from);
    transforms.insert(parent + " " + from.get_text());
  }
  EXPECT_EQ(transforms, (std::set<std::string>{"hmd_world hmd_tof_optical", "hmd_world robot_base",
                                               "robot_base glint_pen_tip"}));
}

TEST(ViewedScene, InTheFileHasTheTopicsOfTheView) {
  Cell cell = short_cell(1);
  cell.named_files.push_back({k_urdf_key, "arm.urdf", "<robot name=\"arm\"/>"});
  const CollectedMessages viewed = collected_run(cell, scenario_of(cell), PicturesTo::observer);
  const CollectedMessages recorded =
      collected_run(cell, scenario_of(cell), PicturesTo::file_and_observer);
  EXPECT_EQ(viewed.types, recorded.types);
  for (const auto& [topic, messages] : recorded.messages) {
    EXPECT_EQ(viewed.messages.at(topic).size(), messages.size()) << topic;
  }
  const auto& description = recorded.messages.at(std::string(k_recorded_robot_description_topic));
  CdrReader from(description.front().cdr);
  EXPECT_EQ(from.get_text(), "<robot name=\"arm\"/>");
}

}  // namespace
}  // namespace glint::scene_messages_test
