#include "platform/tools/viewer/viewer_messages.hpp"

#include <utility>
#include <vector>

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "platform/sinks/record/topics.hpp"
#include "platform/tools/viewer/picture_messages.hpp"
#include "platform/tools/viewer/scene_messages.hpp"

namespace glint {
namespace {

constexpr Duration k_decision_period = milliseconds(100);  // of a tool's explanation
constexpr Duration k_repetition = milliseconds(1000);      // of an unchanged one
constexpr Duration k_scene_period = milliseconds(100);
constexpr Duration k_robot_period = milliseconds(2000);  // for viewers that subscribe later

}  // namespace

ViewerMessages::ViewerMessages(const Cell& cell, PicturesTo pictures)
    : cell_(cell),
      pictures_(pictures),
      explainer_(cell),
      scene_shapes_(std::make_unique<SceneMessages>(cell.tools)),
      cdr_(std::make_unique<CdrWriter>()) {
  if (cell.robot_valid && !cell.robot_in_reference) T_world_robot_ = cell.T_world_robot;
  for (const NamedFile& file : cell.named_files) {
    if (file.key == k_urdf_key) urdf_ = file.text;
  }
}

ViewerMessages::~ViewerMessages() = default;

void ViewerMessages::open(DerivedOutput& output, Duration unix_offset) {
  output_ = &output;
  unix_offset_ = unix_offset;
  explanation_ = output.add_channel(k_explanation_topic, "glint_msgs/msg/Explanation",
                                    Destination::file_and_observer);
  if (pictures_ == PicturesTo::none) return;
  const Destination to =
      pictures_ == PicturesTo::observer ? Destination::observer : Destination::file_and_observer;
  picture_ = output.add_channel(k_picture_topic, "sensor_msgs/msg/Image", to);
  camera_info_ = output.add_channel(k_camera_info_topic, "sensor_msgs/msg/CameraInfo", to);
  regions_ = output.add_channel(k_regions_topic, "glint_msgs/msg/Regions", to);
  scene_ = output.add_channel(k_scene_topic, "visualization_msgs/msg/MarkerArray", to);
  transform_ = output.add_channel(k_transform_topic, "tf2_msgs/msg/TFMessage", to);
  if (urdf_.empty()) return;
  robot_description_ =
      output.add_channel(k_recorded_robot_description_topic, "std_msgs/msg/String", to);
}

void ViewerMessages::add(const FramePatch& patch) {
  const FrameLayout& layout = patch.layout;
  if (!explainer_.examines(layout.arrival)) {
    explainer_.add_arrival(layout.mid_exposure, layout.arrival);
    return;
  }
  const FrameBuffer pixels = frame_of(patch);
  const Frame frame = pixels.view(layout.mid_exposure, layout.arrival, layout.sequence);
  const ExaminedFrame& examined = explainer_.add_frame(frame);
  std::vector<Vector3> candidates;
  for (const ExaminedRegion& region : examined.regions) {
    if (region.reason.empty()) candidates.push_back(region.surface_m);
  }
  scene_shapes_->set_candidates(std::move(candidates));
  if (pictures_ != PicturesTo::none) write_pictures(patch, frame, examined);
}

void ViewerMessages::write_pictures(const FramePatch& patch, const Frame& frame,
                                    const ExaminedFrame& examined) {
  const FrameLayout& layout = patch.layout;
  if (layout.reflectivity_bits == 0) return;
  const Time stamp = layout.mid_exposure + unix_offset_;
  write_picture(*cdr_, stamp, frame);
  output_->write(picture_, layout.arrival, cdr_->bytes());
  write_camera_info(*cdr_, stamp, cell_.camera.model);
  output_->write(camera_info_, layout.arrival, cdr_->bytes());
  const std::span rois(layout.rectangles.data(), static_cast<std::size_t>(layout.rectangle_count));
  write_regions(*cdr_, stamp, rois, examined);
  output_->write(regions_, layout.arrival, cdr_->bytes());
}

void ViewerMessages::add(const HeadPose& head) {
  explainer_.add_head(head);
  if (pictures_ == PicturesTo::none || !head.valid) return;
  write_transform_from_world(k_camera_frame, head.T_world_camera, head.time);
}

void ViewerMessages::add(const DroppedInput& input) {
  explainer_.add_refused(input.arrival, input.reason);
}

// A robot on the reference body moves with it in the world: its transform is not derived here.
void ViewerMessages::add(const RobotFrameRecord& robot) {
  const bool valid =
      robot.state == RegistrationState::given || robot.state == RegistrationState::accepted;
  if (!valid || robot.in_reference) return;
  T_world_robot_ = robot.T_world_robot;
  next_robot_ = Time{};
}

void ViewerMessages::add(const ButtonEvent& event) { scene_shapes_->add(event); }

void ViewerMessages::write_transform_from_world(std::string_view child, const Pose& pose,
                                                Time time) {
  write_transform(*cdr_, time + unix_offset_, k_world_frame, child, pose);
  output_->write(transform_, time, cdr_->bytes());
}

void ViewerMessages::write_scene(Time time) {
  if (time < next_scene_) return;
  next_scene_ = time + k_scene_period;
  scene_shapes_->write(*cdr_, time + unix_offset_);
  output_->write(scene_, time, cdr_->bytes());
}

void ViewerMessages::write_robot(Time time) {
  if (time < next_robot_) return;
  next_robot_ = time + k_robot_period;
  if (T_world_robot_) write_transform_from_world(k_robot_frame, *T_world_robot_, time);
  if (urdf_.empty()) return;
  cdr_->begin();
  cdr_->put(std::string_view(urdf_));
  output_->write(robot_description_, time, cdr_->bytes());
}

void ViewerMessages::add(const PoseSample& sample) {
  explainer_.add_output(sample);
  scene_shapes_->add(sample);
  if (pictures_ != PicturesTo::none && sample.tool == 0) {
    write_scene(sample.tick);
    write_robot(sample.tick);
  }
  Published& published = published_[sample.tool];
  if (published.any && sample.tick - published.decided < k_decision_period) return;
  published.decided = sample.tick;
  const Explanation now = explainer_.explanation(sample.tool);
  const bool changed = !published.any || now.text != published.explanation.text;
  if (!changed && sample.tick - published.written < k_repetition) return;
  published.any = true;
  published.written = sample.tick;
  published.explanation = now;
  write_explanation(sample, now);
}

void ViewerMessages::write_explanation(const PoseSample& sample, const Explanation& explanation) {
  cdr_->begin();
  put_header(*cdr_, sample.tick + unix_offset_, k_camera_frame);
  cdr_->put(cell_.tools.items[sample.tool].name.data());
  cdr_->put(explanation.state);
  cdr_->put(explanation.reason);
  cdr_->put(explanation.text);
  output_->write(explanation_, sample.tick, cdr_->bytes());
}

}  // namespace glint
