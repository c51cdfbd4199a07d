// Topic names of a recording, equal to those in ROS and DDS.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glint {

inline constexpr std::string_view k_frame_topic = "/glint/frame";
inline constexpr std::string_view k_reflectivity_topic = "/glint/reflectivity";
inline constexpr std::string_view k_depth_topic = "/glint/depth";
inline constexpr std::string_view k_head_pose_topic = "/glint/head_pose";
inline constexpr std::string_view k_markers_topic = "/glint/blobs";
inline constexpr std::string_view k_choice_topic = "/glint/choice";
inline constexpr std::string_view k_output_topic = "/glint/output";
inline constexpr std::string_view k_dropped_topic = "/glint/dropped";
inline constexpr std::string_view k_button_topic = "/glint/button";
inline constexpr std::string_view k_robot_frame_topic = "/glint/robot_frame";
inline constexpr std::string_view k_pen_buttons_topic = "/glint/pen_buttons";
inline constexpr std::string_view k_stroke_topic = "/glint/stroke";  // of `glint path`
inline constexpr std::string_view k_transform_topic = "/tf";
inline constexpr std::string_view k_explanation_topic = "/glint/explanation";
inline constexpr std::string_view k_picture_topic = "/glint/picture";
inline constexpr std::string_view k_camera_info_topic = "/glint/camera_info";
inline constexpr std::string_view k_regions_topic = "/glint/regions";
inline constexpr std::string_view k_scene_topic = "/glint/scene";
inline constexpr std::string_view k_recorded_robot_description_topic = "/robot_description";

// Letters, digits and '_' of the name; "toolN" if the result is empty or the tool has no name.
[[nodiscard]] std::string topic_name(const std::vector<std::string>& tool_names, std::size_t tool);

struct RecordedTopics {
  std::string pose;             // tool 0: /glint/pen_pose; others: /glint/NAME/pose
  std::string pose_covariance;  // the same, with _cov
  std::string tip_frame;        // glint_NAME_tip
};
[[nodiscard]] RecordedTopics tool_topics(const std::vector<std::string>& tool_names,
                                         std::size_t tool);

}  // namespace glint
