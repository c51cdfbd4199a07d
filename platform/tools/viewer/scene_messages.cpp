#include "platform/tools/viewer/scene_messages.hpp"

#include <utility>

#include "platform/sinks/record/ros_messages.hpp"

namespace glint {
namespace {

// Of visualization_msgs/Marker.
constexpr std::int32_t k_line_strip = 4, k_sphere_list = 7;
constexpr std::int32_t k_add = 0, k_delete = 2;
constexpr double k_line_width_m = 0.002, k_candidate_size_m = 0.008;
constexpr Duration k_first_spacing = milliseconds(10);

struct Color {
  float red = 0, green = 0, blue = 0;
};
constexpr Color k_measured{0.1F, 0.8F, 0.2F}, k_predicted{1.0F, 0.6F, 0.1F},
    k_candidate{0.2F, 0.5F, 1.0F}, k_stroke{0.9F, 0.1F, 0.6F};

struct Shape {
  std::string_view frame, name_space;
  std::int32_t id = 0, type = 0;
  Pose pose;
  double size_m = 0;
  Color color;
};

// Without points the marker is deleted.
void put_marker(CdrWriter& to, Time stamp, const Shape& shape, std::span<const Vector3> points) {
  put_header(to, stamp, shape.frame);
  to.put(shape.name_space);
  to.put(shape.id);
  to.put(shape.type);
  to.put(points.empty() ? k_delete : k_add);
  put_pose(to, shape.pose);
  put_vector(to, Vector3::Constant(shape.size_m));
  for (const float part : {shape.color.red, shape.color.green, shape.color.blue, 1.0F})
    to.put(part);
  to.put(std::int32_t{0});  // lifetime: until replaced
  to.put(std::uint32_t{0});
  to.put(false);  // frame_locked
  to.put_length(points.size());
  for (const Vector3& point : points) put_vector(to, point);
  to.put_length(0);            // colors
  to.put("");                  // texture_resource
  put_header(to, Time{}, "");  // texture: none
  to.put("");
  to.put_bytes({});
  to.put_length(0);  // uv_coordinates
  to.put("");        // text
  to.put("");        // mesh_resource
  to.put("");        // mesh_file: none
  to.put_bytes({});
  to.put(false);  // mesh_use_embedded_materials
}

}  // namespace

void SceneMessages::add(const PoseSample& sample) {
  newest_[sample.tool] = sample;
  if (sample.tool == 0 && draws_ && sample.has_pose()) add_stroke_point(sample);
}

void SceneMessages::add(const ButtonEvent& event) {
  if (event.button != Button::draw) return;
  draws_ = event.pressed;
  stroke_.clear();
  stroke_spacing_ = k_first_spacing;
  newest_point_ = Time{};
}

void SceneMessages::add_stroke_point(const PoseSample& sample) {
  if (!stroke_.empty() && sample.frame != stroke_frame_) stroke_.clear();
  if (!stroke_.empty() && sample.tick - newest_point_ < stroke_spacing_) return;
  if (stroke_.size() == k_stroke_points_max) {
    for (std::size_t i = 0; i < k_stroke_points_max / 2; ++i) stroke_[i] = stroke_[2 * i];
    stroke_.resize(k_stroke_points_max / 2);
    stroke_spacing_ = stroke_spacing_ * 2;
  }
  stroke_frame_ = sample.frame;
  newest_point_ = sample.tick;
  stroke_.push_back(sample.pose.translation);
}

void SceneMessages::write(CdrWriter& to, Time stamp) const {
  to.begin();
  to.put_length(2 * static_cast<std::size_t>(tools_.count) + 2);
  for (std::size_t t = 0; t < static_cast<std::size_t>(tools_.count); ++t) write_tool(to, stamp, t);
  write_candidates(to, stamp);
  write_stroke(to, stamp);
}

// The tool's markers, and a line from its tip to their middle.
void SceneMessages::write_tool(CdrWriter& to, Time stamp, std::size_t t) const {
  const PoseSample& sample = newest_[t];
  const Tool& tool = tools_.items[t];
  std::vector<Vector3> markers, line;
  if (sample.has_pose()) {
    for (int i = 0; i < tool.marker_count; ++i) {
      markers.push_back(tool.markers_m[static_cast<std::size_t>(i)] - tool.tip_m);
    }
    line = {Vector3::Zero(), tool.middle_m() - tool.tip_m};
  }
  Shape shape;
  shape.frame = frame_name(sample.frame);
  shape.name_space = tool.name.data();
  shape.pose = sample.pose;
  shape.color = sample.state == TrackState::measured ? k_measured : k_predicted;
  shape.id = 0;
  shape.type = k_sphere_list;
  shape.size_m = 2 * tool.marker_radius_m;
  put_marker(to, stamp, shape, markers);
  shape.id = 1;
  shape.type = k_line_strip;
  shape.size_m = k_line_width_m;
  put_marker(to, stamp, shape, line);
}

void SceneMessages::write_candidates(CdrWriter& to, Time stamp) const {
  Shape shape;
  shape.frame = k_camera_frame;
  shape.name_space = "candidates";
  shape.type = k_sphere_list;
  shape.size_m = k_candidate_size_m;
  shape.color = k_candidate;
  put_marker(to, stamp, shape, candidates_);
}

void SceneMessages::write_stroke(CdrWriter& to, Time stamp) const {
  Shape shape;
  shape.frame = frame_name(stroke_frame_);
  shape.name_space = "stroke";
  shape.type = k_line_strip;
  shape.size_m = k_line_width_m;
  shape.color = k_stroke;
  put_marker(to, stamp, shape, stroke_);
}

}  // namespace glint
