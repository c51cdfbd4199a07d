#include "platform/tools/programming/path_capture.hpp"

#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_path_points_max = 1 << 22;
constexpr int k_elements_max = 1 << 20;

void check_capture(bool right, const std::string& what) {
  if (!right) throw InputError("path: " + what);
}

}  // namespace

PathCapture::PathCapture(const CaptureSettings& settings) : settings_(settings) {
  check_capture(resampler_.begin(settings.stroke) == Reason::none,
                "stroke settings; expected numbers above 0, turns of at most pi");
  check_capture(settings.click_max.nanoseconds >= 0 && settings.click_radius_m >= 0,
                "click settings; expected 0 or more");
  check_capture(settings.points_max >= 1 && settings.points_max <= k_path_points_max,
                "points_max; expected 1 to " + std::to_string(k_path_points_max));
  check_capture(settings.elements_max >= 1 && settings.elements_max <= k_elements_max,
                "elements_max; expected 1 to " + std::to_string(k_elements_max));
  const auto elements = static_cast<std::size_t>(settings.elements_max);
  points_.reserve(static_cast<std::size_t>(settings.points_max));
  elements_.reserve(elements);
  active_.reserve(elements);
  changes_.reserve(2 * elements);  // each is added once, and deleted once apart from undos
}

void PathCapture::add(const ButtonEvent& event) {
  if (finished_) {
    ++counts_.inputs_after_finish;
    return;
  }
  switch (event.button) {
    case Button::draw:
      if (event.pressed != held_) event.pressed ? press(event.time) : release(event.time);
      break;
    case Button::delete_last:
      if (event.pressed) delete_last();
      break;
    case Button::undo:
      if (event.pressed) undo();
      break;
    case Button::finish:
      if (event.pressed) finish();
      break;
  }
}

void PathCapture::add(const PoseSample& sample) {
  if (finished_) {
    ++counts_.inputs_after_finish;
    return;
  }
  if (!held_ || sample.tick < pressed_) return;
  ++counts_.poses;
  if (sample.state != TrackState::measured) {
    ++counts_.not_measured;
    return;
  }
  if (sample.frame != ReferenceFrame::robot) {
    ++counts_.not_in_robot;
    return;
  }
  const UncertainPose pose{sample.tick, sample.pose, sample.covariance};
  Reason reason = resampler_.add(pose);
  if (reason == Reason::too_old) {
    ++counts_.gaps;
    end_stroke();
    split_by_gap_ = true;
    begin_stroke();
    reason = resampler_.add(pose);
  }
  if (reason != Reason::none) {
    ++counts_.not_usable;
    return;
  }
  ++counts_.poses_accepted;
  if (samples_++ == 0) began_ = pose.pose.translation;
  left_click_radius_ =
      left_click_radius_ || (pose.pose.translation - began_).norm() > settings_.click_radius_m;
  take_points();
}

void PathCapture::finish() {
  if (held_) end_stroke();
  held_ = false;
  finished_ = true;
}

void PathCapture::press(Time time) {
  held_ = true;
  pressed_ = time;
  split_by_gap_ = false;
  begin_stroke();
}

void PathCapture::release(Time time) {
  held_ = false;
  const bool click =
      !split_by_gap_ && !left_click_radius_ && time - pressed_ <= settings_.click_max;
  if (click && static_cast<int>(points_.size()) > first_point_) {
    points_.resize(static_cast<std::size_t>(first_point_) + 1);
    store({PathKind::waypoint, first_point_, 1});
    return;
  }
  end_stroke();
}

void PathCapture::begin_stroke() {
  (void)resampler_.begin(settings_.stroke);  // the constructor checked the settings
  first_point_ = static_cast<int>(points_.size());
  samples_ = 0;
  left_click_radius_ = truncated_ = false;
}

void PathCapture::end_stroke() {
  resampler_.end();
  take_points();
  const int count = static_cast<int>(points_.size()) - first_point_;
  if (count == 0) {
    ++counts_.presses_without_effect;
    return;
  }
  store({count == 1 ? PathKind::waypoint : PathKind::stroke, first_point_, count});
}

void PathCapture::take_points() {
  UncertainPose point;
  for (;;) {
    const StrokeResampler::Next next = resampler_.next(point);
    if (next == StrokeResampler::Next::none) return;
    if (next == StrokeResampler::Next::replace_last) {
      if (!truncated_) points_.back() = point;
    } else if (static_cast<int>(points_.size()) < settings_.points_max) {
      points_.push_back(point);
    } else {
      ++counts_.points_over_capacity;
      truncated_ = true;
    }
  }
}

void PathCapture::store(Element element) {
  if (static_cast<int>(elements_.size()) == settings_.elements_max) {
    ++counts_.strokes_over_capacity;
    points_.resize(static_cast<std::size_t>(element.first));
    return;
  }
  const int number = static_cast<int>(elements_.size());
  elements_.push_back(element);
  active_.push_back(number);
  changes_.push_back({true, number});
}

void PathCapture::delete_last() {
  if (held_ || active_.empty()) {
    ++counts_.presses_without_effect;
    return;
  }
  changes_.push_back({false, active_.back()});
  active_.pop_back();
}

void PathCapture::undo() {
  if (held_ || changes_.empty()) {
    ++counts_.presses_without_effect;
    return;
  }
  const Change change = changes_.back();
  changes_.pop_back();
  if (change.added) {
    active_.pop_back();
  } else {
    active_.push_back(change.element);
  }
}

DrawnPath PathCapture::path() const {
  DrawnPath path;
  for (const int number : active_) {
    const Element& element = elements_[static_cast<std::size_t>(number)];
    const auto first = points_.begin() + element.first;
    path.push_back({element.kind, {first, first + element.count}});
  }
  return path;
}

}  // namespace glint
