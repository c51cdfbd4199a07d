#include "platform/sinks/dds/topic_names.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(TopicNames, AreWhatRos2Expects) {
  const ToolTopics topics = topics_of("glint", "pen");
  EXPECT_EQ(topics.pose, "rt/glint/pen_pose");
  EXPECT_EQ(topics.pose_covariance, "rt/glint/pen_pose_covariance");
  EXPECT_EQ(topics.pose_systematic, "rt/glint/pen_pose_systematic");
  EXPECT_EQ(topics.status, "rt/glint/pen_status");
  EXPECT_EQ(topics.tip_frame, "glint_pen_tip");
}

TEST(TopicNames, OfANamedRunAreInItsNamespace) {
  const ToolTopics topics = topics_of("glint", "pen", "left");
  EXPECT_EQ(topics.pose, "rt/left/glint/pen_pose");
  EXPECT_EQ(topics.tip_frame, "glint_pen_tip") << "tf is in the namespace too";
  EXPECT_EQ(topic_in("left", k_tf_topic), "rt/left/tf");
  EXPECT_EQ(topic_in("", k_tf_topic), "rt/tf");
  EXPECT_EQ(topics_of(DdsInput::buttons, "glint", "left").front(), "rt/left/glint/button");
  EXPECT_EQ(topics_of(DdsInput::tools, "glint", "").back(), "rt/glint/tool_remove");
}

TEST(TopicNames, HoldLettersDigitsAndUnderscoresOnly) {
  EXPECT_EQ(ros_name("Pen_2"), "Pen_2");
  EXPECT_EQ(ros_name("8700339"), "tool_8700339");
  EXPECT_EQ(ros_name("stylus long/\xC3\xA9"), "stylus_long___");
  EXPECT_EQ(ros_name(""), "tool_");
}

}  // namespace
}  // namespace glint
