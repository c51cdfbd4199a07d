// Order of a recording's releases in which each activation finds the data that it read.
//
// Choices are recorded after the activation: a tick's choice may precede the frame whose estimates
// it read, or follow the next frame. Therefore a tick waits for its frame. A frame waits for a tick
// that read it or a later one: all ticks that read older estimates are released by then.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <utility>

#include "nodes/tokens.hpp"
#include "platform/runtime/session/release_order.hpp"
#include "platform/runtime/session/release_records.hpp"
#include "platform/sinks/record/recording_format.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

// Versions published by a group that is not replayed; each is recorded before a tick reads it.
template <class T>
class RecordedVersions {
 public:
  void add(std::uint64_t version, const T& value) { values_[version] = value; }
  // Versions are read in increasing order; erases the older ones.
  void publish(std::uint64_t version) {
    const auto value = values_.find(version);
    if (value == values_.end()) return;
    buffer_.write_slot() = published_ = value->second;
    buffer_.publish(version, 0);
    values_.erase(values_.begin(), std::next(value));
  }
  [[nodiscard]] graph::TripleBuffer<T>& buffer() noexcept { return buffer_; }
  [[nodiscard]] const T& published() const noexcept { return published_; }  // the newest one

 private:
  std::map<std::uint64_t, T> values_;
  graph::TripleBuffer<T> buffer_;
  T published_{};
};

class RecordedOrder {
 public:
  // Capacity of the queues. A recording that needs more lacks messages: then the oldest entry is
  // released, and a tick that finds other estimates is counted.
  static constexpr std::size_t k_frames_queued_max = 64, k_ticks_queued_max = 1024;

  // Calls `on_output` with each recorded output record. `cell`: the recorded one.
  RecordedOrder(const Cell& cell, RecordingReader& reader,
                std::function<void(OutputMessage&)> on_output)
      : by_clock_(cell.tick_release == TickRelease::clock),
        reader_(reader),
        on_output_(std::move(on_output)) {}

  // Robot pose and buttons that the ticks read; published before next() returns the tick.
  RecordedVersions<RobotFrame> robot;
  RecordedVersions<PenButtons> buttons;

  // Returns false at the end of the recording. Throws InputError.
  [[nodiscard]] bool next(NextRelease& release) {
    while (!tick_is_due() && !frame_is_due()) {
      if (ended_) return false;
      read();
    }
    if (tick_is_due()) {
      tick_ = ticks_.front();
      ticks_.pop_front();
      robot.publish(tick_.versions[1]);
      buttons.publish(tick_.versions[2]);
      release = {tick_.nominal, nullptr, tick_number(), &tick_};
    } else {
      frame_ = std::move(frames_.front());
      frames_.pop_front();
      arrived_ = {frame_.frame.view(), frame_.head, -1, &frame_.markers};
      release = {frame_.frame.arrival, &arrived_, 0, &frame_.choice};
    }
    return true;
  }

  // Whether messages are missing before the current position.
  [[nodiscard]] bool has_gap() const noexcept { return gaps_ > 0; }
  // Frames after a gap without a head pose or a choice; they are not released.
  [[nodiscard]] std::int64_t frames_without_inputs() const noexcept { return without_inputs_; }

 private:
  struct QueuedFrame {
    FrameMessage frame;  // at level blobs without pixels
    MarkerFrame markers;
    HeadPose head;
    ChoiceRecord choice;
  };

  [[nodiscard]] bool tick_is_due() const {
    if (ticks_.empty()) return false;
    const std::uint64_t read = ticks_.front().versions[0];
    if (read <= frame_.choice.activation) return true;
    if (!frames_.empty()) return read < frames_.front().choice.activation;
    return ended_ || ticks_.size() > k_ticks_queued_max;
  }
  // If no tick is due, the waiting ticks read this frame or a later one.
  [[nodiscard]] bool frame_is_due() const {
    return !frames_.empty() && (!ticks_.empty() || ended_ || frames_.size() > k_frames_queued_max);
  }

  // By the clock, skipped ticks have numbers too.
  [[nodiscard]] std::uint64_t tick_number() const {
    if (!by_clock_) return tick_.activation - 1;
    return static_cast<std::uint64_t>(tick_.nominal.nanoseconds /
                                      reader_.nominal_tick().nanoseconds);
  }

  void read() {
    auto message = reader_.next();
    if (reader_.gaps() != gaps_) has_head_ = has_choice_ = false;
    gaps_ = reader_.gaps();
    ended_ = !message;
    if (message) std::visit([this](auto& item) { on(item); }, *message);
  }
  void on(HeadPose& head) {
    head_ = head;
    has_head_ = true;
  }
  void on(ChoiceRecord& choice) {
    if (choice.group == k_frame_group) {
      choice_ = choice;
      has_choice_ = true;
    } else if (choice.group == k_tick_group) {
      // Older recordings have no version of the buttons: 0 means that none was held.
      choice.version_count = 3;
      ticks_.push_back(choice);
    }
  }
  void on(FrameMessage& frame) {
    if (records_frames(reader_.level())) enqueue({std::move(frame), {}, {}, {}});
  }
  void on(MarkerFrame& markers) {
    if (records_frames(reader_.level())) return;
    enqueue({{markers.mid_exposure, markers.stamp_sigma, markers.arrival, markers.sequence, {}},
             markers,
             {},
             {}});
  }
  void on(OutputMessage& output) { on_output_(output); }
  void on(RobotFrameRecord& frame) {
    robot.add(frame.version, {frame.state, frame.T_world_robot, frame.rms_m, frame.in_reference});
  }
  void on(PenButtonsRecord& held) { buttons.add(held.version, {held.held}); }
  void on(DroppedInput& /*input*/) {}  // its frame is recorded as well
  void on(ButtonEvent& /*event*/) {}   // ticks read the held buttons

  void enqueue(QueuedFrame held) {
    if (has_gap()) {
      if (!has_head_ || !has_choice_) {
        ++without_inputs_;
        return;
      }
      activation_ = std::max(activation_ + 1, choice_.activation) - 1;
    }
    // A frame without a choice keeps the tool set of the frame before, and was in time.
    if (choice_.activation != ++activation_) choice_.overrun = {};
    choice_.activation = activation_;
    choice_.version_count = 1;
    choice_.versions[0] = std::max<std::uint64_t>(choice_.versions[0], 1);
    held.head = head_;
    held.choice = choice_;
    frames_.push_back(std::move(held));
  }

  bool by_clock_;  // the ticks' release
  RecordingReader& reader_;
  std::function<void(OutputMessage&)> on_output_;
  std::deque<QueuedFrame> frames_;
  std::deque<ChoiceRecord> ticks_;
  QueuedFrame frame_;  // released last, as are the next two
  ArrivedFrame arrived_;
  ChoiceRecord tick_;
  HeadPose head_;                             // the last one read
  ChoiceRecord choice_;                       // of the frame group, likewise
  std::uint64_t activation_ = 0;              // of the last frame read
  bool has_head_ = true, has_choice_ = true;  // since the newest gap
  std::uint64_t gaps_ = 0;
  bool ended_ = false;
  std::int64_t without_inputs_ = 0;
};

}  // namespace glint
