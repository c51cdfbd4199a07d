#include "platform/tools/viewer/viewer_messages.hpp"

#include "platform/sinks/record/cdr.hpp"
#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/ros_messages.hpp"
#include "platform/sinks/record/topics.hpp"
#include "platform/tools/viewer/picture_messages.hpp"

namespace glint {
namespace {

constexpr Duration k_decision_period = milliseconds(100);  // of a tool's explanation
constexpr Duration k_repetition = milliseconds(1000);      // of an unchanged one

std::size_t searched_pixels(const FrameLayout& layout) {
  std::size_t pixels = 0;
  for (int i = 0; i < layout.rectangle_count; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    pixels += static_cast<std::size_t>(roi.x1 - roi.x0) * static_cast<std::size_t>(roi.y1 - roi.y0);
  }
  return pixels;
}

}  // namespace

ViewerMessages::ViewerMessages(const Cell& cell, PicturesTo pictures)
    : cell_(cell), pictures_(pictures), explainer_(cell), cdr_(std::make_unique<CdrWriter>()) {}

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
}

void ViewerMessages::add(const FramePatch& patch) {
  const FrameLayout& layout = patch.layout;
  if (!explainer_.examines(layout.arrival)) {
    explainer_.add_arrival(layout.mid_exposure, layout.arrival);
    return;
  }
  const FrameBuffer pixels = frame_of(patch);
  const Frame frame = pixels.view(layout.mid_exposure, layout.arrival, layout.sequence);
  const ExaminedFrame& examined = explainer_.add_frame(frame, searched_pixels(layout));
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

void ViewerMessages::add(const HeadPose& head) { explainer_.add_head(head); }

void ViewerMessages::add(const DroppedInput& input) {
  explainer_.add_refused(input.arrival, input.reason);
}

void ViewerMessages::add(const RobotFrameRecord&) {}

void ViewerMessages::add(const ButtonEvent&) {}

void ViewerMessages::add(const PoseSample& sample) {
  explainer_.add_output(sample);
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
