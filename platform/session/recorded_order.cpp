#include "platform/session/recorded_order.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "platform/record/recording_format.hpp"
#include "platform/session/choices.hpp"

namespace glint {
namespace {

constexpr std::uint8_t k_frame_versions = 1, k_tick_versions = 3;  // Latest<> inputs of the groups

}  // namespace

RecordedOrder::RecordedOrder(RecordingReader& reader, const RobotFrame& robot,
                             std::function<void(OutputMessage&)> on_output,
                             std::function<void(double seconds)> progress)
    : reader_(reader), on_output_(std::move(on_output)), progress_(std::move(progress)) {
  robot_.add(1, robot);
}

bool RecordedOrder::next(NextRelease& release) {
  for (;;) {
    if (tick_is_due()) {
      tick_ = ticks_.front();
      ticks_.pop_front();
      robot_.publish(tick_.versions[1]);
      buttons_.publish(tick_.versions[2]);
      // Ticks that were skipped have numbers, too.
      const auto number = tick_.nominal.nanoseconds / reader_.nominal_tick().nanoseconds;
      release = {tick_.nominal, nullptr, static_cast<std::uint64_t>(number), &tick_};
      return true;
    }
    if (frame_is_due()) {
      frame_ = std::move(frames_.front());
      frames_.pop_front();
      released_ = frame_.choice.activation;
      arrived_ = {frame_.frame.view(), frame_.head, -1, &frame_.markers};
      release = {frame_.frame.arrival, &arrived_, 0, &frame_.choice};
      return true;
    }
    if (ended_) return false;
    read();
  }
}

bool RecordedOrder::tick_is_due() const {
  if (ticks_.empty()) return false;
  const std::uint64_t read = ticks_.front().versions[0];
  if (read <= released_) return true;
  if (!frames_.empty()) return read < frames_.front().choice.activation;
  return ended_ || ticks_.size() > k_ticks_held_max;
}

// Where no tick is due, those that wait read this frame or a later one.
bool RecordedOrder::frame_is_due() const {
  return !frames_.empty() && (!ticks_.empty() || ended_ || frames_.size() > k_frames_held_max);
}

void RecordedOrder::read() {
  auto message = reader_.next();
  if (reader_.gaps() != gaps_) head_since_gap_ = choice_since_gap_ = false;
  gaps_ = reader_.gaps();
  ended_ = !message;
  if (message) std::visit([this](auto& item) { on(item); }, *message);
}

void RecordedOrder::on(FrameMessage& frame) {
  if (keeps_frames(reader_.level())) hold(std::move(frame), {});
}

void RecordedOrder::on(MarkerFrame& frame) {
  if (keeps_frames(reader_.level())) return;
  hold({frame.mid_exposure, frame.arrival, frame.sequence, {}}, frame);
}

void RecordedOrder::hold(FrameMessage frame, MarkerFrame markers) {
  // Behind a gap the choice has the frame's number; the first frame may lack its inputs.
  if (has_gap()) {
    if (!head_since_gap_ || !choice_since_gap_) {
      ++frames_without_inputs_;
      return;
    }
    activation_ = std::max(activation_ + 1, frame_choice_.activation) - 1;
  }
  // A frame without its choice has the tools of the one before, and was in time.
  if (frame_choice_.activation != ++activation_) frame_choice_.overrun = {};
  frame_choice_.activation = activation_;
  frame_choice_.version_count = k_frame_versions;
  frame_choice_.versions[0] = std::max<std::uint64_t>(frame_choice_.versions[0], 1);
  frames_.push_back({std::move(frame), std::move(markers), head_, frame_choice_});
}

void RecordedOrder::on(ChoiceRecord& choice) {
  if (progress_) progress_((choice.nominal - Time{}).seconds());
  if (choice.group == k_frame_group) {
    frame_choice_ = choice;
    choice_since_gap_ = true;
  } else if (choice.group == k_tick_group) {
    // Older recordings have no version of the buttons: 0, none was ever held.
    choice.version_count = k_tick_versions;
    ticks_.push_back(choice);
  }
}

void RecordedOrder::on(OutputMessage& output) { on_output_(output); }

void RecordedOrder::on(HeadPose& head) {
  head_ = head;
  head_since_gap_ = true;
}

void RecordedOrder::on(RobotFrameRecord& frame) {
  robot_.add(frame.version, {frame.state, frame.T_world_robot, frame.rms_m, frame.in_reference});
}

void RecordedOrder::on(PenButtonsRecord& buttons) { buttons_.add(buttons.version, {buttons.held}); }

}  // namespace glint
