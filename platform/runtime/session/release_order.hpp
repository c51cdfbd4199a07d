// Deterministic order of releases without a clock: frames and ticks run one after the other in one
// thread, by their nominal times or in the order of a recording.
#pragma once

#include <atomic>
#include <cstdint>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/runtime/session/tick_releases.hpp"
#include "platform/sinks/record/choice_record.hpp"

namespace glint {

// Release of the frame group or of the tick group.
struct NextRelease {
  Time nominal;
  const ArrivedFrame* frame = nullptr;     // null: a tick. Valid until the next call of next()
  std::uint64_t tick = 0;                  // the tick's number
  const ChoiceRecord* recorded = nullptr;  // of a replay; validity likewise
};

// Runs all releases of `order` by on_frame(const NextRelease&) and on_tick(const NextRelease&).
template <class Order, class OnFrame, class OnTick>
void run_releases(Order& order, const OnFrame& on_frame, const OnTick& on_tick) {
  for (NextRelease release; order.next(release);) {
    if (release.frame != nullptr) {
      on_frame(release);
    } else {
      on_tick(release);
    }
  }
}

// Order of a run: frames at their arrival, ticks at their releases until the last frame's poses are
// lost. At equal times the frame is first.
class NominalOrder {
 public:
  // `estimates`: those of the frames that this order releases. `stop` may be null. When it is set,
  // no more frames are taken.
  NominalOrder(const Cell& cell, FrameSource& source, const MeasuredEstimates& estimates,
               const std::atomic<bool>* stop)
      : source_(source),
        estimates_(estimates),
        stop_(stop),
        releases_(cell),
        lost_after_(cell.lost_after) {}

  // Returns false if nothing is left.
  [[nodiscard]] bool next(NextRelease& release) {
    if (!frame_waits_ && !frames_ended_) take_frame();
    const MeasuredEstimate newest = estimates_.newest();
    if (const Time tick = releases_.next(newest); tick < until_) {
      release = {tick, nullptr, number_++};
      releases_.released(tick, newest);
      return true;
    }
    release = {until_, &arrived_};
    frame_waits_ = false;
    return !frames_ended_;
  }

 private:
  void take_frame() {
    if (any_frame_) source_.release_pixels(arrived_);
    const Time last = until_;
    frame_waits_ = any_frame_ = (stop_ == nullptr || !*stop_) && source_.wait(arrived_);
    frames_ended_ = !frame_waits_;
    until_ = frames_ended_ ? last + lost_after_ : arrived_.frame.arrival;
  }

  FrameSource& source_;
  const MeasuredEstimates& estimates_;
  const std::atomic<bool>* stop_;
  TickReleases releases_;
  Duration lost_after_;
  ArrivedFrame arrived_;
  Time until_;  // arrival of the waiting frame, or the end time of the ticks
  std::uint64_t number_ = 0;
  bool any_frame_ = false, frame_waits_ = false, frames_ended_ = false;
};

}  // namespace glint
