// The releases of a recording, in an order in which each activation finds what it read.
//
// Choices are recorded after the fact: a tick's may stand in front of the frame whose estimates it
// read, or behind the next one. So a tick waits for its frame, and a frame waits for a tick that
// read it or a later one: all ticks that read older estimates are released by then.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>

#include "graph/latest.hpp"
#include "nodes/tokens.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/release_order.hpp"

namespace glint {

// What a group outside of the replay published: each version is recorded before a tick reads it.
template <class T>
class RecordedVersions {
 public:
  void add(std::uint64_t version, const T& value) { values_[version] = value; }
  // Versions only rise: the older ones are not read again.
  void publish(std::uint64_t version) {
    const auto value = values_.find(version);
    if (value == values_.end()) return;
    buffer_.write_slot() = value->second;
    buffer_.publish(version, 0);
    values_.erase(values_.begin(), std::next(value));
  }
  [[nodiscard]] graph::TripleBuffer<T>& buffer() noexcept { return buffer_; }

 private:
  std::map<std::uint64_t, T> values_;
  graph::TripleBuffer<T> buffer_;
};

class RecordedOrder {
 public:
  // What is held back at most. A recording that needs more lacks messages: what waits longest is
  // released then, and a tick that finds other estimates is counted.
  static constexpr std::size_t k_frames_held_max = 64, k_ticks_held_max = 1024;

  // `robot`: version 1, which no recording holds. `on_output` is called with each recorded output
  // record in front of the first gap; `progress`, which may be empty, with the time reached.
  RecordedOrder(RecordingReader& reader, const RobotFrame& robot,
                std::function<void(OutputMessage&)> on_output,
                std::function<void(double seconds)> progress);

  // False: the recording ends here. What a tick read of the robot and of the buttons is published
  // by then. Throws InputError.
  [[nodiscard]] bool next(NextRelease& release);

  // Messages are missing in front of what was read so far.
  [[nodiscard]] bool has_gap() const noexcept { return gaps_ > 0; }
  // Frames behind a gap that lack their head pose or their choice: they are not released.
  [[nodiscard]] std::int64_t frames_without_inputs() const noexcept {
    return frames_without_inputs_;
  }
  [[nodiscard]] RecordedVersions<RobotFrame>& robot() noexcept { return robot_; }
  [[nodiscard]] RecordedVersions<PenButtons>& buttons() noexcept { return buttons_; }

 private:
  struct HeldFrame {
    FrameMessage frame;  // at level blobs without pixels
    MarkerFrame markers;
    HeadPose head;
    ChoiceRecord choice;
  };

  [[nodiscard]] bool tick_is_due() const;
  [[nodiscard]] bool frame_is_due() const;
  void read();
  void hold(FrameMessage frame, MarkerFrame markers);
  void on(FrameMessage& frame);
  void on(MarkerFrame& frame);
  void on(ChoiceRecord& choice);
  void on(OutputMessage& output);
  void on(HeadPose& head);
  void on(RobotFrameRecord& frame);
  void on(PenButtonsRecord& buttons);
  void on(DroppedInput& /*input*/) {}  // the frame is there as well
  void on(ButtonEvent& /*event*/) {}   // ticks read what was held by then

  RecordingReader& reader_;
  std::function<void(OutputMessage&)> on_output_;
  std::function<void(double)> progress_;
  RecordedVersions<RobotFrame> robot_;
  RecordedVersions<PenButtons> buttons_;
  std::deque<HeldFrame> frames_;
  std::deque<ChoiceRecord> ticks_;
  HeldFrame frame_;  // released last
  ArrivedFrame arrived_;
  ChoiceRecord tick_;
  HeadPose head_;                                // of the next frame
  ChoiceRecord frame_choice_;                    // likewise, in front of it; after it, its own
  std::uint64_t activation_ = 0, released_ = 0;  // of the frame read last; of the one released last
  std::uint64_t gaps_ = 0;
  bool head_since_gap_ = true, choice_since_gap_ = true, ended_ = false;
  std::int64_t frames_without_inputs_ = 0;
};

}  // namespace glint
